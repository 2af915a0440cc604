#include "renderer/core/rng.h"
#include "renderer/integrator/path_tracer.h"
#include "renderer/scene/scene.h"
#include "tests/support/long_run.h"
#include "tests/support/small_scenes.h"

#include <gtest/gtest.h>

// Scenes whose radiance is known in closed form, and a second, simpler estimator for the rest.

namespace rapport {
namespace {

using tests::level_square;
using tests::settings;
using Surfaces = std::vector<Surface>;
using Lights = std::vector<std::shared_ptr<Light>>;

/// A spot of the floor at the origin, seen from below any lamp.
const Camera kSpot = tests::parallel_camera({0.2f, 0.1f, 0.3f}, {0, 0, 0}, 1e-3f, 8);

Image picture(const Surfaces& surfaces, const Lights& lights, const RenderSettings& how,
              const Camera& camera = kSpot) {
    return render(Scene(surfaces, lights, camera, how)).image();
}

/// An image of `radiance` without noise, to compare with.
Image even(const Image& like, double radiance) {
    Image image(like.width, like.height, {"R", "G", "B", "variance.R", "variance.G", "variance.B"});
    for (size_t c = 0; c < 3; ++c)
        std::ranges::fill(image.data[c], static_cast<float>(radiance));
    return image;
}

double mean(const Image& image) {
    double sum = 0;
    for (const float value : *image.find("R"))
        sum += value;
    return sum / static_cast<double>(image.find("R")->size());
}

/// Irradiance at the centre below a square of half width `half`, `height` above it, of radiance 1
/// (four times the corner-to-rectangle configuration factor, times π).
double irradiance_below(double half, double height) {
    const double a = half / height, r = std::sqrt(1 + a * a);
    return 4 * (a / r) * std::atan(a / r);
}

Surfaces floor_under_lamp(float height) {
    Surfaces surfaces{tests::surface(level_square(5, 0), tests::diffuse(0.5f)),
                      tests::surface(level_square(1, height), tests::diffuse(0), 2)};
    tests::turn_over(surfaces[1]); // shines down
    return surfaces;
}

TEST(ClosedScene, SunOnAPlane) {
    const glm::vec3 towards_sun = glm::normalize(glm::vec3(1, 0, 2));
    const Image image = picture({tests::surface(level_square(5, 0), tests::diffuse(0.5f))},
                                {tests::sun(3, towards_sun)}, settings(4, 5));
    const float truth = 3 * towards_sun.z * 0.5f / static_cast<float>(kPi);
    EXPECT_LT(compare(image, even(image, truth)).max_absolute, 1e-6);
}

/// To the plane, to the sun, and on into the sky, of which a path without scattering has the first.
TEST(ClosedScene, RaysOfAPathUnderTheSun) {
    for (const auto& [depth, rays] : {std::pair(0, 1), {1, 3}}) {
        const Scene scene({tests::surface(level_square(5, 0), tests::diffuse(0.5f))},
                          {tests::sun(3, {0, 0, 1})}, kSpot, settings(1, depth));
        Film film(kSpot.resolution);
        Film::Tile& tile = film.tiles()[0];
        const glm::ivec2 size = tile.end - tile.first;
        EXPECT_EQ(sample_tile(scene, CameraRays(kSpot), film, tile, 2), rays * 2 * size.x * size.y);
    }
}

TEST(ClosedScene, LampOverAPlane) {
    for (const float height : {0.5f, 2.0f}) {
        const double truth = 2 * irradiance_below(1, height) * 0.5 / kPi;
        const Image image = picture(floor_under_lamp(height), {}, settings(1024, 1));
        EXPECT_TRUE(compare(image, even(image, truth)).agree) << mean(image) << ' ' << truth;
        // Scattering that is counted both ways, as without weights, would double it; so would a
        // percent too much be seen.
        EXPECT_FALSE(compare(image, even(image, 1.01 * truth)).agree);
        EXPECT_EQ(mean(picture(floor_under_lamp(height), {}, settings(4, 0))), 0);
    }
}

TEST(ClosedScene, ALampShinesFromItsFaceOnly) {
    Surfaces surfaces = floor_under_lamp(1);
    tests::turn_over(surfaces[1]);
    EXPECT_EQ(mean(picture(surfaces, {}, settings(16, 1))), 0);
    surfaces[1].two_sided_emission = true;
    EXPECT_GT(mean(picture(surfaces, {}, settings(16, 1))), 0.1);
}

TEST(ClosedScene, ClothDimsWhatIsSeenThroughIt) {
    const auto cloth = tests::half_open_cloth();
    for (const int layers : {1, 3}) {
        Surfaces surfaces;
        for (int i = 0; i < layers; ++i)
            surfaces.push_back(
                tests::surface(level_square(5, 0.1f * static_cast<float>(i)), cloth));
        const double truth = 4 * std::pow(0.5, layers);
        // Depth 0 still shows it: passing through is no scattering event.
        for (const int depth : {0, 3}) {
            const Image sky = picture(surfaces, {tests::sky(4)}, settings(256, depth));
            EXPECT_TRUE(compare(sky, even(sky, truth)).agree) << mean(sky) << ' ' << truth;
            EXPECT_FALSE(compare(sky, even(sky, 1.1 * truth)).agree);
        }
        Surfaces lamp = surfaces;
        lamp.push_back(tests::surface(level_square(5, -1), tests::diffuse(0), 4));
        const Image seen = picture(lamp, {}, settings(256, 3));
        EXPECT_TRUE(compare(seen, even(seen, truth)).agree) << mean(seen) << ' ' << truth;
    }
}

TEST(ClosedScene, ClothDimsTheLightOnWhatItShades) {
    const auto cloth = tests::half_open_cloth();
    for (const int layers : {1, 3}) {
        Surfaces surfaces = floor_under_lamp(0.5f);
        for (int i = 0; i < layers; ++i) // below the camera's way to the floor
            surfaces.push_back(
                tests::surface(level_square(4, 1e-4f * static_cast<float>(i + 1)), cloth));
        const double share = std::pow(0.5, layers);
        Camera under = tests::parallel_camera({0, 0, 5e-5f}, {0, 0, 0}, 1e-6f, 8);
        const double truth = share * 2 * irradiance_below(1, 0.5) * 0.5 / kPi;
        const Image lamp = picture(surfaces, {}, settings(1024, 1), under);
        EXPECT_TRUE(compare(lamp, even(lamp, truth)).agree) << mean(lamp) << ' ' << truth;
        EXPECT_FALSE(compare(lamp, even(lamp, 1.2 * truth)).agree);

        surfaces.erase(surfaces.begin() + 1);
        const Image sunlit = picture(surfaces, {tests::sun(1, {0, 0, 1})}, settings(4, 1), under);
        EXPECT_NEAR(mean(sunlit), share * 0.5 / kPi, 1e-6);
    }
}

/// The reference: scattering is followed as sampled, and light is counted where a path happens to
/// meet it. No light sampling, weights, or roulette. `counted_twice` is the deliberately wrong
/// twin, for which light at the end of a scattered path counts double, as without MIS weights.
Rgb simple_radiance(const Scene& scene, kernel::Ray ray, CounterRng& rng, bool counted_twice) {
    Rgb radiance(0), throughput(1);
    for (int depth = 0;;) {
        const float share = depth > 0 && counted_twice ? 2 : 1;
        const auto point = scene.intersect(ray);
        if (!point) {
            for (const auto& choice : scene.distant_lights())
                radiance += share * throughput * choice.light->escaped(ray.dir).radiance;
            return radiance;
        }
        if (const AreaLight* light = point->surface->area_light.get())
            radiance += share * throughput * light->emitted(point->geometric_normal, -ray.dir);
        const Bsdf& material = *point->surface->material;
        const glm::vec3 eye = point->frame.to_local(-ray.dir);
        const Rgb unscattered = material.unscattered(eye);
        if (rng.uniform_float() < 0.5f) {
            throughput *= 2.0f * unscattered;
            ray = {offset_origin(*point, ray.dir), ray.dir};
        } else {
            const float choice = rng.uniform_float();
            const glm::vec2 u(rng.uniform_float(), rng.uniform_float());
            const auto sample = material.sample(eye, choice, u);
            if (!sample || depth++ == scene.settings.max_depth)
                return radiance;
            throughput *= 2.0f * sample->weight;
            const glm::vec3 direction = point->frame.to_world(sample->light);
            ray = {offset_origin(*point, direction), direction};
        }
        if (throughput == Rgb(0))
            return radiance;
    }
}

Image simple_picture(const Scene& scene, int samples, bool counted_twice) {
    const glm::ivec2 size = scene.camera.resolution;
    Image image(size.x, size.y, {"R", "G", "B", "variance.R", "variance.G", "variance.B"});
    for (int pixel = 0; pixel < size.x * size.y; ++pixel) {
        glm::dvec3 sum(0), squares(0);
        for (int sample = 0; sample < samples; ++sample) {
            CounterRng rng(9, Purpose::test, static_cast<uint64_t>(pixel),
                           static_cast<uint64_t>(sample));
            const glm::vec2 film(static_cast<float>(pixel % size.x) + rng.uniform_float(),
                                 static_cast<float>(pixel / size.x) + rng.uniform_float());
            const glm::dvec3 value(
                simple_radiance(scene, scene.camera.ray(film), rng, counted_twice));
            sum += value;
            squares += value * value;
        }
        for (int c = 0; c < 3; ++c) {
            const double variance = (squares[c] - sum[c] * sum[c] / samples) / (samples - 1);
            image.data[static_cast<size_t>(c)][static_cast<size_t>(pixel)] =
                static_cast<float>(sum[c] / samples);
            image.data[static_cast<size_t>(c) + 3][static_cast<size_t>(pixel)] =
                static_cast<float>(variance / samples);
        }
    }
    return image;
}

/// Satin that scatters both ways and lets light pass, between a lamp, the sky, and a floor.
Scene mixed_scene(Sampler::Kind sampler, uint64_t seed, int samples) {
    Surfaces surfaces = floor_under_lamp(1.5f);
    surfaces[1].mesh = std::make_shared<const TriangleMesh>(
        tests::parallelogram({-2, -2, 2}, {0, 4, 0}, {4, 0, 1}));
    TriangleMesh sheet = tests::parallelogram({-1.5f, -1.5f, 0.5f}, {3, 0, 0.4f}, {0, 3, 0.2f});
    static const auto satin = tests::cloth(tests::satin_intensity, 0.25);
    surfaces.push_back(tests::surface(std::move(sheet), satin));
    return Scene(surfaces, {tests::sky(0.3f)},
                 tests::parallel_camera({1, -6, 3}, {0, 0, 0.4f}, 1.6f, 16),
                 settings(samples, 4, sampler, seed));
}

TEST(MixedScene, AgreesWithTheSimpleEstimatorAndBothSamplers) {
    const int samples = tests::long_run() ? 4096 : 512;
    const Image image = render(mixed_scene(Sampler::Kind::independent, 1, samples)).image();
    const Image sobol = render(mixed_scene(Sampler::Kind::sobol, 2, samples)).image();
    const Scene scene = mixed_scene(Sampler::Kind::independent, 3, 1);
    const Image simple = simple_picture(scene, 2 * samples, false);
    EXPECT_TRUE(compare(image, sobol).agree) << compare(image, sobol).p_value;
    EXPECT_TRUE(compare(image, simple).agree) << compare(image, simple).p_value;
    EXPECT_TRUE(compare(sobol, simple).agree) << compare(sobol, simple).p_value;
    EXPECT_FALSE(compare(image, simple_picture(scene, 2 * samples, true)).agree);
}

} // namespace
} // namespace rapport
