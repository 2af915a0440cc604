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

/// A shipped cloth in dyes that need not be solved for.
Cloth dyed_cloth(const std::string& name) {
    Cloth cloth = tests::clear_cloth(name);
    for (FibreSpec* fibre : {&cloth.warp.fibre, &cloth.weft.fibre})
        fibre->absorption_per_um = {0.01, 0.001, 0};
    return cloth;
}

BsdfTable measured_table(const Cloth& cloth, const std::vector<tests::EyeAndLight>& pairs,
                         uint64_t paths) {
    MeasureOptions options;
    options.goniophotometer = {.accuracy = 1e-6, .max_paths = 64};
    BsdfTable table = measure_cloth(cloth, options).table;
    options.goniophotometer.max_paths = paths;
    for (const tests::EyeAndLight& pair : pairs)
        options.incidence.push_back(pair.eye);
    tests::put_in(measure_cloth(cloth, options).table, table);
    return table;
}

class FarView : public testing::TestWithParam<const char*> {};

TEST_P(FarView, OfExplicitFibresEqualsThatOfTheirTable) {
    std::vector<tests::EyeAndLight> pairs{
        {{Side::front, 60 * kDegree, 225 * kDegree}, 30, 50},
        {{Side::front, 40 * kDegree, 270 * kDegree}, 128, 95},
        {{Side::back, 30 * kDegree, 30 * kDegree}, 55, 200},
    };
    if (tests::long_run())
        pairs.insert(pairs.end(), {
                                      {{Side::front, 30 * kDegree, 45 * kDegree}, 60, 230},
                                      {{Side::front, 20 * kDegree, 0}, 50, 180},
                                      {{Side::front, 50 * kDegree, 180 * kDegree}, 20, 0},
                                      {{Side::front, 60 * kDegree, 90 * kDegree}, 35, 270},
                                      {{Side::front, 30 * kDegree, 315 * kDegree}, 65, 90},
                                      {{Side::back, 40 * kDegree, 90 * kDegree}, 160, 270},
                                      {{Side::back, 20 * kDegree, 180 * kDegree}, 140, 10},
                                      {{Side::back, 60 * kDegree, 270 * kDegree}, 40, 60},
                                      {{Side::front, 70 * kDegree, 135 * kDegree}, 110, 330},
                                  });
    const Cloth cloth = dyed_cloth(GetParam());
    const int samples = tests::long_run() ? 20'000 : 800;
    const auto table = std::make_shared<const TableBsdf>(measured_table(cloth, pairs, 64 * samples),
                                                         "swatch.bsdf");
    constexpr float kWindow = 0.03f, kSwatch = 0.15f; // half widths [m]
    const auto swatch =
        std::make_shared<const FibreSwatch>(cloth, glm::dvec2(2e6 * kSwatch), std::string());
    double chi2 = 0, wrong_chi2 = 0;
    for (const tests::EyeAndLight& pair : pairs) {
        const glm::dvec3 eye = towards_light(pair.eye), light = pair.light();
        const tests::Estimate fibres = tests::seen_under_disc(tests::fibre_surface(swatch), eye,
                                                              light, kWindow, samples, 1000);
        const tests::Estimate picture = tests::seen_under_disc(
            tests::surface(tests::level_square(kSwatch, 0), tests::cloth_of(table)), eye, light,
            kWindow, 1024, 1);
        // The table was measured by as many paths as the picture of the fibres has; what the bins
        // of the mesh do to a disc of 10° is let be 3 %.
        const double variance =
            2 * fibres.variance + picture.variance + square(0.03 * fibres.mean / 3.5);
        const double difference = picture.mean - fibres.mean;
        EXPECT_LT(std::abs(difference), 3.5 * std::sqrt(variance))
            << "eye at " << pair.eye.theta / kDegree << ", light at " << pair.light_theta << ": "
            << fibres.mean << " ± " << std::sqrt(fibres.variance) << ", by table " << picture.mean;
        chi2 += square(difference) / variance;

        // The wrong twin leaves out the cosine that unequal angles bring out.
        const double wrong = picture.mean * std::abs(std::cos(pair.eye.theta) / light.z);
        wrong_chi2 += square(wrong - fibres.mean) / variance;
    }
    const double bound = pairs.size() + 5 * std::sqrt(2.0 * pairs.size());
    EXPECT_LT(chi2, bound);
    EXPECT_GT(wrong_chi2, bound);
    std::printf("%s: chi² %.1f, without the cosine %.1f, over %zu pairs\n", GetParam(), chi2,
                wrong_chi2, pairs.size());
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
