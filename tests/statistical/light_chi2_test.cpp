#include "renderer/core/image.h"
#include "renderer/core/rng.h"
#include "renderer/scene/scene.h"
#include "tests/support/long_run.h"
#include "tests/support/small_scenes.h"
#include "tests/support/statistics.h"
#include "tests/support/temporary_folder.h"

#include <functional>
#include <gtest/gtest.h>

// Every light: the directions that `sample` draws follow the density that it reports, and that the
// path tracer asks for where a BSDF sample happens to meet the light.

namespace rapport {
namespace {

using Density = std::function<double(const glm::vec3&)>;

constexpr int kRows = 16, kColumns = 32; ///< cells of equal solid angle, in z and φ

size_t cell_of(const glm::vec3& w) {
    const int row = std::clamp(static_cast<int>((w.z + 1) / 2 * kRows), 0, kRows - 1);
    const int column =
        std::clamp(static_cast<int>(azimuth(w) / (2 * kPi) * kColumns), 0, kColumns - 1);
    return static_cast<size_t>(row * kColumns + column);
}

/// Integral of the density over a cell, by a midpoint rule of `steps` each way.
double integral(const Density& density, size_t cell, int steps) {
    const size_t row = cell / kColumns, column = cell % kColumns;
    double sum = 0;
    for (int i = 0; i < steps; ++i)
        for (int j = 0; j < steps; ++j) {
            const double z = -1 + 2 * (row + (i + 0.5) / steps) / kRows;
            const double phi = 2 * kPi * (column + (j + 0.5) / steps) / kColumns;
            sum += density(glm::vec3(spherical_direction(std::acos(z), phi)));
        }
    return sum * 4 * kPi / (kRows * kColumns * square(double(steps)));
}

/// Expected counts of `samples` draws.
std::vector<double> expected_counts(const Density& density, int samples,
                                    const std::vector<double>& observed) {
    constexpr int kSteps = 96, kFineSteps = 32 * kSteps;
    std::vector<double> expected;
    for (size_t cell = 0; cell < observed.size(); ++cell) {
        double share = integral(density, cell, kSteps);
        if (share == 0 && observed[cell] > 0) // a bright pixel's corner reaches in, if anything
            share = integral(density, cell, kFineSteps);
        expected.push_back(samples * share);
    }
    return expected;
}

struct LightCase {
    std::string name;
    std::shared_ptr<const Light> light;
    Density density;
};

/// p-value of the light's draws from the origin against `density`.
double p_value(const LightCase& test, const Density& density, int samples) {
    std::vector<double> observed(kRows * kColumns);
    int drawn = 0, disagreements = 0;
    for (int i = 0; i < samples; ++i) {
        CounterRng rng(3, Purpose::test, 0, static_cast<uint64_t>(i));
        const glm::vec2 u(rng.uniform_float(), rng.uniform_float());
        const auto sample = test.light->sample(glm::vec3(0), u);
        if (!sample)
            continue;
        ++drawn;
        EXPECT_FALSE(sample->delta);
        EXPECT_NEAR(glm::length(sample->direction), 1, 1e-5f);
        disagreements += std::abs(sample->pdf / test.density(sample->direction) - 1) > 2e-3;
        ++observed[cell_of(sample->direction)];
    }
    EXPECT_GT(drawn, 0.99 * samples) << test.name;
    EXPECT_LE(disagreements, 1e-4 * samples) << test.name; // rounding at the edge of a pixel
    return tests::chi_square_test(observed, expected_counts(density, drawn, observed)).p_value;
}

/// An EXR with a bright spot, a gradient, and a black third.
std::filesystem::path test_image(const tests::TemporaryFolder& folder, int width, int height) {
    Image image(width, height, {"R", "G", "B"});
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x)
            for (size_t c = 0; c < 3; ++c)
                image.data[c][static_cast<size_t>(y * width + x)] =
                    x < width / 3 ? 0
                                  : (x == width / 2 && y == height / 3 ? 40.0f : 0.3f) +
                                        static_cast<float>(y) / static_cast<float>(height);
    const std::filesystem::path path = folder / ("sky" + std::to_string(width) + ".exr");
    write_exr(image, path);
    return path;
}

std::shared_ptr<Light> image_light(const std::filesystem::path& path, const glm::mat4& to_world) {
    Params params("test", "infinite", 1);
    Param file;
    file.type = "string";
    file.name = "filename";
    file.strings = {path.filename().string()};
    params.add(file);
    return make_light("infinite", {params, path.parent_path(), to_world});
}

LightCase infinite_case(const std::string& name, const std::shared_ptr<Light>& light) {
    light->prepare(glm::vec3(0), 1);
    return {name, light, [light](const glm::vec3& w) { return light->escaped(w).pdf; }};
}

LightCase area_case() {
    TriangleMesh mesh = tests::level_square(1, -0.6f);
    mesh.positions[2] += glm::vec3(0.8f, 0.3f, 0.2f); // two triangles of unequal area and tilt
    const auto scene = std::make_shared<const Scene>(
        std::vector<Surface>{tests::surface(mesh, tests::diffuse(0), 1)},
        std::vector<std::shared_ptr<Light>>{}, Camera{}, RenderSettings{});
    const std::shared_ptr<const AreaLight> light = scene->surfaces()[0].area_light;
    return {"area", light, [scene, light](const glm::vec3& w) {
                const auto point = scene->intersect({glm::vec3(0), w});
                return point ? light->pdf(point->position, point->geometric_normal) : 0.0f;
            }};
}

TEST(LightChiSquare, SamplesFollowTheirDensity) {
    const tests::TemporaryFolder folder;
    const glm::mat4 turned = glm::rotate(glm::mat4(1), 0.7f, glm::normalize(glm::vec3(1, 2, 3)));
    const glm::mat4 mirrored = glm::scale(turned, glm::vec3(-2, 2, 2));
    const std::vector<LightCase> cases{
        infinite_case("octahedral", image_light(test_image(folder, 12, 12), turned)),
        infinite_case("latitude-longitude", image_light(test_image(folder, 24, 12), mirrored)),
        area_case(),
    };
    const int samples = tests::long_run() ? 2'000'000 : 200'000;
    const double significance = tests::sidak(0.01, static_cast<int>(cases.size()));
    for (const LightCase& test : cases) {
        EXPECT_GE(p_value(test, test.density, samples), significance) << test.name;
        const Density wrong = [&](const glm::vec3& w) {
            return test.density(w) * (1 + 0.05 * (w.x > 0 ? 1 : -1));
        };
        EXPECT_LT(p_value(test, wrong, samples), significance)
            << test.name << ": a wrong density was accepted";
    }
}

TEST(LightChiSquare, TheSunComesFromOneDirection) {
    const auto light = tests::sun(2, {0, 3, 4});
    const auto sample = light->sample({7, 8, 9}, {0.1f, 0.2f});
    ASSERT_TRUE(sample);
    EXPECT_TRUE(sample->delta);
    EXPECT_EQ(sample->radiance, Rgb(2));
    EXPECT_LT(glm::length(sample->direction - glm::vec3(0, 0.6f, 0.8f)), 1e-6f);
    EXPECT_EQ(light->escaped(sample->direction).radiance, Rgb(0));
}

/// Where things stand in an image light: one bright pixel, looked up.
TEST(ImageLight, IsOrientedAsItsHeaderSays) {
    const tests::TemporaryFolder folder;
    const auto bright = [&](int width, int height, int x, int y) {
        Image image(width, height, {"R", "G", "B"});
        for (auto& plane : image.data)
            plane[static_cast<size_t>(y * width + x)] = 1;
        write_exr(image, folder / "spot.exr");
        return image_light(folder / "spot.exr", glm::mat4(1));
    };
    const auto seen = [](const std::shared_ptr<Light>& light, const glm::vec3& w) {
        return light->escaped(glm::normalize(w)).radiance.g > 0.2f;
    };
    // Latitude–longitude, 16 × 8: the zenith above; +x in the middle; −y to its right.
    EXPECT_TRUE(seen(bright(16, 8, 3, 0), spherical_direction(0.196f, 1.96f)));
    EXPECT_TRUE(seen(bright(16, 8, 8, 4), {1, -0.2f, -0.2f}));
    EXPECT_TRUE(seen(bright(16, 8, 12, 4), {-0.2f, -1, -0.2f}));
    // Equal-area octahedral, 8 × 8: +z in the middle, +x to the right, +y below, −z in the corners.
    EXPECT_TRUE(seen(bright(8, 8, 4, 4), {0.1f, 0.1f, 1}));
    EXPECT_TRUE(seen(bright(8, 8, 7, 4), {1, 0.1f, 0}));
    EXPECT_TRUE(seen(bright(8, 8, 4, 7), {0.1f, 1, 0}));
    EXPECT_TRUE(seen(bright(8, 8, 0, 0), {-0.1f, -0.1f, -1}));
    EXPECT_FALSE(seen(bright(8, 8, 0, 0), {0.1f, 0.1f, 1}));
}

} // namespace
} // namespace rapport
