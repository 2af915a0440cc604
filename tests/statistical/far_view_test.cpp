#include "renderer/integrator/path_tracer.h"
#include "renderer/scene/shape/fibre_swatch.h"
#include "tests/support/long_run.h"
#include "tests/support/swatch.h"
#include "vgsp/measure_cloth.h"

#include <gtest/gtest.h>

// The close-up and the far view are one cloth: a swatch of explicit fibres, seen from so far that a
// pixel is many repeats wide, equals the same swatch with the table that was measured of it.

namespace rapport {
namespace {

using tests::kDegree;

/// An eye at a node of the table's grid, and three discs, of red, green and blue light, whose paths
/// are shared: one for each dye of the cloth.
struct EyeAndDiscs {
    IncidentDirection eye;
    std::array<glm::dvec2, 3> lights; ///< θ and φ [°], as in tests::EyeAndLight

    tests::EyeAndLight pair(int channel) const {
        return {eye, lights[channel].x, lights[channel].y};
    }
};

/// A shipped cloth in dyes that need not be solved for.
Cloth dyed_cloth(const std::string& name) {
    Cloth cloth = tests::clear_cloth(name);
    for (FibreSpec* fibre : {&cloth.warp.fibre, &cloth.weft.fibre})
        fibre->absorption_per_um = {0.002, 0.001, 0};
    return cloth;
}

BsdfTable measured_table(const Cloth& cloth, const std::vector<EyeAndDiscs>& views,
                         uint64_t paths) {
    MeasureOptions options;
    options.goniophotometer = {.accuracy = 1e-6, .max_paths = 64};
    BsdfTable table = measure_cloth(cloth, options).table;
    options.goniophotometer.max_paths = paths;
    for (const EyeAndDiscs& view : views)
        options.incidence.push_back(view.eye);
    tests::put_in(measure_cloth(cloth, options).table, table);
    return table;
}

class FarView : public testing::TestWithParam<const char*> {};

TEST_P(FarView, OfExplicitFibresEqualsThatOfTheirTable) {
    // Flat eyes with steep light and the other way round, reflected and transmitted.
    std::vector<EyeAndDiscs> views{
        {{Side::front, 60 * kDegree, 225 * kDegree}, {{{30, 50}, {128, 95}, {35, 270}}}},
        {{Side::back, 30 * kDegree, 30 * kDegree}, {{{55, 200}, {140, 270}, {35, 60}}}},
    };
    if (tests::long_run())
        views.insert(
            views.end(),
            {
                {{Side::front, 30 * kDegree, 45 * kDegree}, {{{60, 230}, {65, 90}, {110, 330}}}},
                {{Side::front, 20 * kDegree, 0}, {{{50, 180}, {40, 270}, {140, 10}}}},
                {{Side::back, 60 * kDegree, 270 * kDegree}, {{{40, 60}, {160, 90}, {20, 0}}}},
            });
    const Cloth cloth = dyed_cloth(GetParam());
    const int samples = tests::long_run() ? 4'000 : 1'000;
    const auto table = std::make_shared<const TableBsdf>(measured_table(cloth, views, 64 * samples),
                                                         "swatch.bsdf");
    constexpr float kWindow = 0.03f, kSwatch = 0.15f; // half widths [m]
    const auto swatch =
        std::make_shared<const FibreSwatch>(cloth, glm::dvec2(2e6 * kSwatch), std::string());
    double chi2 = 0, wrong_chi2 = 0;
    for (const EyeAndDiscs& view : views) {
        const glm::dvec3 eye = towards_light(view.eye);
        std::vector<tests::Disc> discs(3);
        for (int c = 0; c < 3; ++c) {
            discs[c] = {view.pair(c).light(), Rgb(0)};
            discs[c].radiance[c] = 1;
        }
        const auto by_fibres = tests::seen_under_discs(tests::fibre_surface(swatch), eye, discs,
                                                       kWindow, samples, 1000);
        const auto by_table = tests::seen_under_discs(
            tests::surface(tests::level_square(kSwatch, 0), tests::cloth_of(table)), eye, discs,
            kWindow, 1024, 1);
        for (int c = 0; c < 3; ++c) {
            const tests::Estimate &fibres = by_fibres[c], &picture = by_table[c];
            // The table was measured by as many paths as the picture of the fibres has; what the
            // bins of the mesh do to a disc of 10° is let be 3 %.
            const double variance =
                2 * fibres.variance + picture.variance + square(0.03 * fibres.mean / 3.5);
            const double difference = picture.mean - fibres.mean;
            EXPECT_LT(std::abs(difference), 3.5 * std::sqrt(variance))
                << "eye at " << view.eye.theta / kDegree << ", light at " << view.lights[c].x
                << ": " << fibres.mean << " ± " << std::sqrt(fibres.variance) << ", by table "
                << picture.mean;
            chi2 += square(difference) / variance;
            std::printf("  eye %3.0f %4.0f, light %4.0f %4.0f: fibres %.5f ± %.5f, table %.5f\n",
                        (view.eye.side == Side::front ? 1 : -1) * view.eye.theta / kDegree,
                        view.eye.phi / kDegree, view.lights[c].x, view.lights[c].y, fibres.mean,
                        std::sqrt(fibres.variance), picture.mean);

            // The wrong twin leaves out the cosine that unequal angles bring out.
            const double wrong =
                picture.mean * std::abs(std::cos(view.eye.theta) / discs[c].light.z);
            wrong_chi2 += square(wrong - fibres.mean) / variance;
        }
    }
    const double pairs = 3.0 * static_cast<double>(views.size());
    const double bound = pairs + 5 * std::sqrt(2 * pairs);
    EXPECT_LT(chi2, bound);
    EXPECT_GT(wrong_chi2, bound);
    std::printf("%s: chi² %.1f, without the cosine %.1f, over %.0f pairs\n", GetParam(), chi2,
                wrong_chi2, pairs);
}

INSTANTIATE_TEST_SUITE_P(Cloths, FarView,
                         testing::Values("viscose-plain", "viscose-satin", "linen"),
                         [](const auto& info) {
                             std::string name = info.param;
                             std::ranges::replace(name, '-', '_');
                             return name;
                         });

} // namespace
} // namespace rapport
