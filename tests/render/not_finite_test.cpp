#include "renderer/integrator/path_tracer.h"
#include "tests/support/small_scenes.h"

#include <gtest/gtest.h>
#include <limits>

namespace rapport {
namespace {

/// Absorbs what comes at an angle, but what comes nearly straight makes it stumble.
class Stumbling final : public Bsdf {
  public:
    Rgb eval(const glm::vec3& eye, const glm::vec3&) const override {
        return Rgb(eye.z > 0.95f ? std::numeric_limits<float>::quiet_NaN() : 0);
    }
    float pdf(const glm::vec3&, const glm::vec3&) const override { return 0; }
    std::optional<BsdfSample> sample(const glm::vec3&, float, const glm::vec2&) const override {
        return std::nullopt;
    }
    Rgb albedo(const glm::vec3&) const override { return Rgb(0.5f); }
};

std::string failure(const glm::vec3& eye) {
    Surface square = tests::surface(tests::level_square(2, 0.25f), std::make_shared<Stumbling>());
    MaterialDescription description;
    description.name = "Stumbling";
    square.description = std::make_shared<const MaterialDescription>(description);
    Camera camera = tests::parallel_camera(eye, {0, 0, 0.25f}, 0.5f, 1);
    camera.resolution = {4, 4};
    const Scene scene({square}, {tests::sun(1, {0, 1, 2})}, camera,
                      tests::settings(3, 4, Sampler::Kind::sobol, 0));
    try {
        render(scene);
    } catch (const std::runtime_error& error) {
        return error.what();
    }
    return {};
}

TEST(NotFinite, StopsThePictureWithThePixelsPath) {
    const std::string told = failure({0.5f, 0, 3});
    EXPECT_NE(told.find("pixel ("), std::string::npos) << told;
    EXPECT_NE(told.find("[nan nan nan] is not finite"), std::string::npos) << told;
    EXPECT_NE(told.find("Stumbling at ["), std::string::npos) << told;
    EXPECT_NE(told.find("0.25] with weight [1 1 1]"), std::string::npos) << told;
    EXPECT_EQ(failure({2.5f, 0, 3}), ""); // seen at an angle, all is well
}

} // namespace
} // namespace rapport
