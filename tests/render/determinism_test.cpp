#include "renderer/core/parallel.h"
#include "renderer/integrator/path_tracer.h"
#include "renderer/scene/scene.h"
#include "tests/support/small_scenes.h"

#include <gtest/gtest.h>
#include <limits>

namespace rapport {
namespace {

Scene scene(Sampler::Kind sampler, uint64_t seed) {
    static const auto satin = tests::cloth(tests::satin_intensity, 0.3);
    std::vector<Surface> surfaces{
        tests::surface(tests::level_square(2, -0.5f), tests::diffuse(0.6f)),
        tests::surface(tests::cube(0.4f), tests::diffuse(0.8f)),
        tests::surface(tests::level_square(0.7f, 0.6f), satin)};
    Camera camera = tests::parallel_camera({3, 4, 5}, {0, 0, 0}, 1.5f, 1);
    camera.resolution = {50, 37}; // tiles cut by the border
    return Scene(std::move(surfaces), {tests::sky(1), tests::sun(1, {1, 0, 1})}, camera,
                 tests::settings(5, 4, sampler, seed));
}

TEST(Determinism, PixelsDoNotDependOnTheThreads) {
    for (const auto sampler : {Sampler::Kind::independent, Sampler::Kind::sobol}) {
        set_thread_count(1);
        const Image one = render(scene(sampler, 0)).image();
        for (const int threads : {2, 7}) {
            set_thread_count(threads);
            EXPECT_EQ(render(scene(sampler, 0)).image().data, one.data) << threads << " threads";
        }
        EXPECT_NE(render(scene(sampler, 1)).image().data, one.data); // another seed
    }
    set_thread_count(0);
}

TEST(Render, WritesTheChannelsItPromises) {
    Scene small = scene(Sampler::Kind::sobol, 0);
    double last = 0;
    RenderWatcher watcher;
    watcher.progress = [&](double share, double samples) {
        EXPECT_GT(share, last);
        EXPECT_EQ(samples, small.settings.samples);
        last = share;
    };
    const Image image = render(small, watcher).image();
    EXPECT_EQ(last, 1);
    EXPECT_EQ(image.channels.size(), 16u);
    for (const auto& plane : image.data)
        for (const float value : plane)
            ASSERT_TRUE(std::isfinite(value));
    // The corner of the picture sees the floor: z up, warp along +y, at the camera's distance.
    const auto at = [&](const char* channel, size_t pixel) {
        return image.find(channel)->at(pixel);
    };
    const size_t floor = 36 * 50 + 25;
    EXPECT_NEAR(at("N.Z", floor), 1, 1e-6);
    EXPECT_NEAR(at("warp.Y", floor), 1, 1e-6);
    EXPECT_NEAR(at("albedo.G", floor), 0.6f, 1e-6);
    EXPECT_GT(at("Z", floor), 5);
    EXPECT_LT(at("Z", floor), 9);

    small.settings.samples = 1;
    EXPECT_EQ(render(small).image().find("variance.R"), nullptr);
}

class BrokenBsdf final : public Bsdf {
  public:
    Rgb eval(const glm::vec3&, const glm::vec3&) const override {
        return Rgb(std::numeric_limits<float>::quiet_NaN());
    }
    float pdf(const glm::vec3&, const glm::vec3&) const override { return 0; }
    std::optional<BsdfSample> sample(const glm::vec3&, float, const glm::vec2&) const override {
        return std::nullopt;
    }
    Rgb albedo(const glm::vec3&) const override { return Rgb(0); }
};

TEST(Render, ANanStopsWithThePixel) {
    const Scene broken({tests::surface(tests::level_square(1, 0), std::make_shared<BrokenBsdf>())},
                       {tests::sun(1, {0, 0, 1})},
                       tests::parallel_camera({0, 0, 2}, {0, 0, 0}, 0.5f, 4),
                       tests::settings(2, 2));
    try {
        render(broken);
        FAIL() << "a NaN went through";
    } catch (const std::runtime_error& error) {
        EXPECT_NE(std::string(error.what()).find("pixel ("), std::string::npos) << error.what();
    }
}

} // namespace
} // namespace rapport
