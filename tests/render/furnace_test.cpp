#include "renderer/integrator/path_tracer.h"
#include "renderer/scene/scene.h"
#include "tests/support/small_scenes.h"
#include "tests/support/statistics.h"

#include <gtest/gtest.h>

// Under equal radiance from everywhere, what absorbs nothing is invisible.

namespace rapport {
namespace {

using tests::settings;

/// Mean over all pixels of channel R, with its standard error.
struct Measured {
    double mean, error;
    double z(double truth) const { return (mean - truth) / std::max(error, 1e-7); }
};

Measured mean_radiance(const Scene& scene) {
    const Image image = render(scene).image();
    double sum = 0, variance = 0;
    const auto& radiance = *image.find("R");
    const auto& variances = *image.find("variance.R");
    for (size_t i = 0; i < radiance.size(); ++i) {
        sum += radiance[i];
        variance += variances[i];
    }
    const double count = static_cast<double>(radiance.size());
    return {sum / count, std::sqrt(variance) / count};
}

Scene furnace(std::vector<Surface> surfaces, int max_depth, int samples = 64) {
    return Scene(std::move(surfaces), {tests::sky(1)},
                 tests::parallel_camera({3, 4, 5}, {0, 0, 0}, 1.5f, 32),
                 settings(samples, max_depth));
}

TEST(Furnace, AConvexWhiteBodyVanishes) {
    EXPECT_LT(
        std::abs(
            mean_radiance(furnace({tests::surface(tests::cube(0.7f), tests::diffuse(1))}, 5)).z(1)),
        4);
    // A body that absorbs a percent is seen.
    EXPECT_GT(std::abs(mean_radiance(
                           furnace({tests::surface(tests::cube(0.7f), tests::diffuse(0.99f))}, 5))
                           .z(1)),
              4);
}

/// Inside a closed body of reflectance ρ paths have the weight ρⁿ after n events, to be scattered
/// once more.
TEST(Furnace, TellsWhatTheDepthCutsOff) {
    TriangleMesh wall = tests::cube(2);
    reverse_orientation(wall);
    for (const int depth : {1, 2, 6}) {
        const Scene inside({tests::surface(wall, tests::diffuse(0.5f))}, {},
                           tests::parallel_camera({0, 0, 0}, {1, 0.2f, 0.3f}, 0.1f, 16),
                           settings(256, depth));
        EXPECT_NEAR(render(inside).cut_share() * std::pow(2, depth), 1, 0.05) << depth;
    }
    EXPECT_EQ(
        render(furnace({tests::surface(tests::cube(0.7f), tests::diffuse(1))}, 1)).cut_share(), 0);
}

/// A cube with the normals of a sphere: up to 54° between shading and geometry.
Surface rounded_cube(float reflectance) {
    TriangleMesh mesh = tests::cube(0.7f);
    for (const glm::vec3& p : mesh.positions)
        mesh.normals.push_back(glm::normalize(p));
    return tests::surface(std::move(mesh), tests::diffuse(reflectance));
}

TEST(Furnace, NormalsOtherThanThoseOfTheSurfaceLoseNoLight) {
    const Measured even = mean_radiance(furnace({rounded_cube(1)}, 5));
    EXPECT_NEAR(even.mean, 1, 1e-5);
    // The same by light samples too: within a lamp all around.
    const auto in_lamp = [](float reflectance) {
        std::vector<Surface> surfaces{rounded_cube(reflectance),
                                      tests::surface(tests::cube(20), tests::diffuse(0), 1)};
        tests::turn_over(surfaces[1]);
        return mean_radiance(Scene(std::move(surfaces), {},
                                   tests::parallel_camera({3, 4, 5}, {0, 0, 0}, 1.5f, 32),
                                   settings(256, 5)));
    };
    EXPECT_LT(std::abs(in_lamp(1).z(1)), 4);
    EXPECT_GT(std::abs(in_lamp(0.98f).z(1)), 4);
}

TEST(Furnace, ManyBouncesBetweenWhiteWallsVanish) {
    std::vector<Surface> corner;
    for (const auto& [a, b] : {std::pair{glm::vec3(2, 0, 0), glm::vec3(0, 2, 0)},
                               {glm::vec3(0, 2, 0), glm::vec3(0, 0, 2)},
                               {glm::vec3(0, 0, 2), glm::vec3(2, 0, 0)}})
        corner.push_back(
            tests::surface(tests::parallelogram(glm::vec3(-0.7f), a, b), tests::diffuse(1)));
    EXPECT_LT(std::abs(mean_radiance(furnace(corner, 1000)).z(1)), 4);
    // Cut after one scattering, light is missing.
    EXPECT_LT(mean_radiance(furnace(corner, 1)).z(1), -4);
}

/// Scatters equally to both sides what does not pass: I = (1 − u)·cosθo / 2π.
TEST(Furnace, AClothThatAbsorbsNothingVanishes) {
    const auto cloth = [](double share) {
        return tests::cloth([share](const IncidentDirection&, const glm::dvec3& out,
                                    size_t) { return share * std::abs(out.z) / (2 * kPi); },
                            0.4);
    };
    const auto sheets = [](const std::shared_ptr<const Bsdf>& material) {
        std::vector<Surface> surfaces;
        for (const float z : {-0.3f, 0.0f, 0.3f})
            surfaces.push_back(tests::surface(tests::level_square(1, z), material));
        return surfaces;
    };
    // The tabulated intensity keeps its bins' energy to about 1e-3.
    EXPECT_NEAR(mean_radiance(furnace(sheets(cloth(0.6)), 1000)).mean, 1, 3e-3);
    EXPECT_LT(mean_radiance(furnace(sheets(cloth(0.5)), 1000)).mean, 0.97);
    std::vector<Surface> tilted = sheets(cloth(0.6));
    for (Surface& sheet : tilted) {
        TriangleMesh mesh = *sheet.mesh;
        mesh.normals.assign(mesh.positions.size(), glm::normalize(glm::vec3(0.4f, -0.3f, 1)));
        sheet.mesh = std::make_shared<const TriangleMesh>(std::move(mesh));
    }
    EXPECT_NEAR(mean_radiance(furnace(tilted, 1000)).mean, 1, 3e-3);
}

} // namespace
} // namespace rapport
