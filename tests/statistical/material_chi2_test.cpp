#include "materials/bsdf.h"
#include "materials/table/export_measured.h"
#include "materials/table/table_bsdf.h"
#include "renderer/core/rng.h"
#include "tests/support/long_run.h"
#include "tests/support/statistics.h"
#include "tests/support/synthetic_tables.h"
#include "tests/support/temporary_folder.h"

#include <gtest/gtest.h>
#include <vector>

// Every registered material: do the directions it samples have the density it claims, is that a
// density, and do the weights carry its albedo?

namespace rapport {
namespace {

constexpr double kSignificance = 0.01; // of a false alarm anywhere in this file
constexpr int kCosines = 60, kPhis = 64, kCells = kCosines * kPhis;
constexpr int kSubdivisions = 4; // of a patch, for its midpoints

struct Case {
    std::string name;
    std::shared_ptr<const Bsdf> material;
    std::string eye_name;
    glm::vec3 eye;
};

/// Of these some light would be scattered twice, which is not followed, and the albedo is an
/// estimate, linear between steps.
bool is_rough_boundary(const std::string& name) {
    return name == "conductor" || name == "dielectric";
}

std::shared_ptr<const Bsdf> make(const std::string& name) {
    Params params("test.pbrt", "Material", 1);
    if (name == "diffuse")
        params.add(
            {.type = "rgb", .name = "reflectance", .numbers = {0.8, 0.5, 0.1}, .strings = {}});
    // What is smooth has no density: tests/unit/specular_test.cpp.
    if (is_rough_boundary(name))
        for (const auto& [direction, roughness] :
             {std::pair("uroughness", 0.1), {"vroughness", 0.3}})
            params.add({.type = "float", .name = direction, .numbers = {roughness}, .strings = {}});
    if (name == "cloth") {
        params.add({.type = "string", .name = "filename", .numbers = {}, .strings = {"satin"}});
        params.add({.type = "float", .name = "rotation", .numbers = {25}, .strings = {}});
    }
    const tests::TemporaryFolder folder;
    if (name == "measured") {
        export_measured(tests::synthetic_table(tests::satin_intensity), "", MeasuredColours::rgb,
                        folder / "satin.bsdf");
        params.add(
            {.type = "string", .name = "filename", .numbers = {}, .strings = {"satin.bsdf"}});
    }
    return make_material(name, {params, folder.path(), [](const auto&, const auto&) {
                                    static const auto table = std::make_shared<const TableBsdf>(
                                        tests::synthetic_table(tests::satin_intensity, 0.05), "");
                                    return table;
                                }});
}

std::vector<Case> cases() {
    std::vector<Case> all;
    for (const std::string& name : MaterialRegistry::instance().names()) {
        const auto material = make(name);
        for (const auto& [theta, phi] :
             {std::pair(0.0, 0.0), {25.0, 71.0}, {56.0, 190.0}, {84.0, 311.0}, {89.9, 45.0}})
            for (const int side : {1, -1}) {
                glm::vec3 eye(spherical_direction(radians(theta), radians(phi)));
                eye.z *= static_cast<float>(side);
                all.push_back({name, material,
                               name + (side > 0 ? " front " : " back ") + std::to_string(theta),
                               eye});
            }
    }
    return all;
}

/// A rectangle of cosθ and φ.
struct Patch {
    double cosine, phi, height, width;

    template <class F> double midpoints(const F& f) const {
        double sum = 0;
        for (int i = 0; i < kSubdivisions; ++i)
            for (int j = 0; j < kSubdivisions; ++j)
                sum += f(glm::vec3(
                    spherical_direction(std::acos(cosine + height * (i + 0.5) / kSubdivisions),
                                        phi + width * (j + 0.5) / kSubdivisions)));
        return sum * height * width / square(kSubdivisions);
    }
    std::array<Patch, 4> quarters() const {
        const double h = height / 2, w = width / 2;
        return {{{cosine, phi, h, w},
                 {cosine + h, phi, h, w},
                 {cosine, phi + w, h, w},
                 {cosine + h, phi + w, h, w}}};
    }
    /// ∫ f, quartered until quarters change less than a tenth of the noise that so many samples of
    /// the density f have. Densities have poles: a file's half vectors crowd towards the mirror
    /// direction and those across the eye, whose density over the light is 1/distance.
    template <class F>
    double integral(const F& f, double samples, double estimate, int depth) const {
        const std::array<Patch, 4> parts = quarters();
        std::array<double, 4> of_part{};
        double sum = 0;
        for (size_t k = 0; k < parts.size(); ++k)
            sum += of_part[k] = parts[k].midpoints(f);
        if (depth == 0 ||
            std::abs(sum - estimate) <= 0.1 * std::sqrt(std::max(sum, 1e-7) / samples))
            return sum;
        sum = 0;
        for (size_t k = 0; k < parts.size(); ++k)
            sum += parts[k].integral(f, samples, of_part[k], depth - 1);
        return sum;
    }
};

/// Integral of f over each cell of the sphere (equal in cosθ and φ), for the comparison with that
/// many samples. The rows next to the horizon begin as strips: what a grazing eye sees is as narrow
/// as its own cosine.
template <class F> std::vector<double> integrate_cells(int samples, const F& f) {
    constexpr int kStrips = 8, kDepth = 8;
    std::vector<double> cells(kCells);
    for (int i = 0; i < kCells; ++i) {
        const int row = i / kPhis;
        const bool grazing = row == kCosines / 2 - 1 || row == kCosines / 2;
        const int strips = grazing ? kStrips : 1;
        const double height = 2.0 / kCosines / strips, width = 2 * kPi / kPhis;
        for (int s = 0; s < strips; ++s) {
            const Patch patch{2.0 * row / kCosines - 1 + s * height, i % kPhis * width, height,
                              width};
            cells[i] += patch.integral(f, samples, patch.midpoints(f), kDepth);
        }
    }
    return cells;
}

size_t cell_of(const glm::vec3& w) {
    const int i = std::clamp(static_cast<int>((w.z + 1) / 2 * kCosines), 0, kCosines - 1);
    const int j = std::min(static_cast<int>(azimuth(w) / (2 * kPi) * kPhis), kPhis - 1);
    return static_cast<size_t>(i * kPhis + j);
}

TEST(MaterialChi2, SamplesHaveTheirDensity) {
    const std::vector<Case> all = cases();
    const double significance = tests::sidak(kSignificance, static_cast<int>(all.size()));
    const int samples = tests::long_run() ? 4000000 : 300000;
    for (size_t c = 0; c < all.size(); ++c) {
        const auto& [name, material, eye_name, eye] = all[c];
        SCOPED_TRACE(eye_name);
        std::vector<double> expected =
            integrate_cells(samples, [&](const glm::vec3& w) { return material->pdf(eye, w); });
        double integral = 0;
        for (double& cell : expected) {
            integral += cell;
            // The midpoints may miss a sliver of the support. Few enough for what no sample can
            // find, half of the cells, to be less than one pool.
            cell = std::max(samples * cell, 1e-3);
        }
        std::vector<double> observed(kCells);
        int lost = 0;
        int disagreements = 0; // where rounding moves a direction over a step of the density
        CounterRng rng(1, Purpose::test, c, 0);
        for (int i = 0; i < samples; ++i) {
            const auto sample = material->sample(eye, rng.uniform_float(),
                                                 {rng.uniform_float(), rng.uniform_float()});
            if (!sample) {
                ++lost;
                continue;
            }
            ASSERT_GT(sample->pdf, 0);
            const float pdf = material->pdf(eye, sample->light);
            disagreements += std::abs(sample->pdf - pdf) > 1e-3f * pdf;
            observed[cell_of(sample->light)] += 1;
        }
        EXPECT_LE(disagreements, samples / 10000);
        const double share_lost = static_cast<double>(lost) / samples;
        EXPECT_NEAR(integral, 1 - share_lost, 2e-3 + 5 * std::sqrt(share_lost / samples));
        EXPECT_LE(share_lost, is_rough_boundary(name) ? 0.3 : 0);
        const auto result = tests::chi_square_test(observed, expected);
        EXPECT_FALSE(result.impossible);
        EXPECT_GT(result.degrees, 100);
        EXPECT_GT(result.p_value, significance)
            << "χ² " << result.statistic << " of " << result.degrees << " degrees";

        // The wrong twin: a density with a tenth of it spread evenly over the sphere.
        for (double& cell : expected)
            cell = 0.9 * cell + 0.1 * samples / kCells;
        EXPECT_LT(tests::chi_square_test(observed, expected).p_value, significance);
    }
}

TEST(MaterialChi2, WeightsAndIntegralsAreTheAlbedo) {
    // The furnace: under even light of radiance 1 a surface shows its albedo.
    const std::vector<Case> all = cases();
    const double significance = tests::sidak(kSignificance, 3 * static_cast<int>(all.size()));
    const int samples = tests::long_run() ? 1000000 : 50000;
    for (size_t c = 0; c < all.size(); ++c) {
        const auto& [name, material, eye_name, eye] = all[c];
        SCOPED_TRACE(eye_name);
        const Rgb albedo = material->albedo(eye);
        CounterRng rng(2, Purpose::test, c, 0);
        tests::RunningMoments weight[3];
        int disagreements = 0;
        for (int i = 0; i < samples; ++i) {
            const auto sample = material->sample(eye, rng.uniform_float(),
                                                 {rng.uniform_float(), rng.uniform_float()});
            if (!sample) {
                for (tests::RunningMoments& moments : weight)
                    moments.add(0);
                continue;
            }
            const Rgb value = material->eval(eye, sample->light);
            const Rgb difference = glm::abs(sample->weight * sample->pdf - value);
            disagreements += glm::any(glm::greaterThan(difference, 1e-3f * value));
            for (int channel = 0; channel < 3; ++channel)
                weight[channel].add(sample->weight[channel]);
        }
        EXPECT_LE(disagreements, samples / 10000);
        // That of a measured file is linear between its incidences and constant beyond; the
        // integral is not.
        const bool linear = name == "measured" || is_rough_boundary(name);
        for (int channel = 0; channel < 3; ++channel) {
            double integral = 0;
            for (const double cell : integrate_cells(
                     samples, [&](const glm::vec3& w) { return material->eval(eye, w)[channel]; }))
                integral += cell;
            EXPECT_NEAR(integral, albedo[channel], (linear ? 0.1 : 2e-3) * albedo[channel] + 1e-6);

            // Besides noise, the rounding of float sums, and the steps of the integral.
            const double truth = linear ? integral : albedo[channel];
            const double error =
                std::hypot(weight[channel].standard_error(), 1e-6, linear ? 1e-3 * integral : 0);
            const double z = (weight[channel].mean() - truth) / error;
            EXPECT_GT(tests::normal_two_sided_p(z), significance) << "z = " << z;
        }
    }
}

} // namespace
} // namespace rapport
