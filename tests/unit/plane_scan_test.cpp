#include "vgsp/plane_scan.h"

#include "renderer/core/parallel.h"
#include "tests/support/fibre_assemblies.h"

#include <gtest/gtest.h>
#include <numeric>

namespace rapport {
namespace {

using kernel::FibreTracer;

const std::vector<FibreOptics> kDyed{{1.53, {0, 0.01, 0.1}, 0.01}};

std::vector<PlaneScan> scanned(const FibreTracer& tracer,
                               const std::vector<IncidentDirection>& incident,
                               const GoniophotometerSettings& settings) {
    return scan_planes({&tracer, 1}, kDyed, Bands{}, incident, settings);
}

int brightest(const PlaneScan& scan, int block) {
    const auto first = scan.mean_intensity.begin() + block * PlaneScan::kAngles;
    return static_cast<int>(std::max_element(first, first + PlaneScan::kAngles) - first);
}

/// Straight fibres along the plane of incidence scatter all light on the cone of the mirror
/// direction: reflected in the plane it leaves at −θ, and transmitted at −θ too.
TEST(PlaneScan, PutsTheMirrorOppositeTheLight) {
    const FibreTracer tracer(tests::fibre_stack(1, 20, 5, 2)); // along y
    for (const Side side : {Side::front, Side::back})
        for (const double plane : {90.0, 270.0})
            for (const double theta : {0.0, 30.0, 45.0}) {
                const PlaneScan scan = scanned(tracer, {{side, radians(theta), radians(plane)}},
                                               {.accuracy = 1e-6, .max_paths = 20'000})[0];
                for (const int block : {0, 1}) {
                    const int peak = brightest(scan, block);
                    EXPECT_NEAR(degrees(PlaneScan::angle(peak)), -theta, 1e-9);
                    for (int bin = 0; bin < PlaneScan::kAngles; ++bin) {
                        const double seen = scan.mean_intensity[block * PlaneScan::kAngles + bin];
                        EXPECT_TRUE(bin == peak ? seen > 0.1 : seen == 0) << bin;
                    }
                }
            }
}

/// What the windows see is the flux through the strip of ± half a width about the plane, and a
/// strip turned out of the plane of incidence sees something else.
TEST(PlaneScan, SeesTheIntensityOfTheGoniophotometer) {
    const FibreTracer tracer(tests::winding_fibres());
    const IncidentDirection incident{Side::front, radians(40.0), radians(67.5)};
    const GoniophotometerSettings settings{.accuracy = 1e-6, .max_paths = 400'000};
    const PlaneScan scan = scanned(tracer, {incident}, settings)[0];
    BsdfTable table = make_partial_table(Bands{}, {incident});
    table.exits = DirectionMesh(36, 36); // of about 5°, and 8° at most beside the horizon
    table.intensity.resize(2 * table.exits.bins() * table.bands.count());
    measure(tracer, kDyed, {.accuracy = 1e-6, .max_paths = 400'000, .seed = 1}, table);
    const ExitBins exits = table.exits_of(0);
    // Averaged over 15° of angle: ten windows against the bins that lie about the plane.
    int disagreements = 0, compared = 0;
    for (const int block : {0, 1})
        for (int degree = -75; degree <= 60; degree += 15) {
            double seen = 0, variance = 0, expected = 0;
            for (int step = 0; step < 10; ++step) {
                const int bin = PlaneScan::kAngles / 2 + degree * 2 / 3 + step;
                seen += scan.intensity[(block * PlaneScan::kAngles + bin) * 3] / 10;
                variance += square(scan.error[(block * PlaneScan::kAngles + bin) * 3] / 10);
            }
            for (int step = 0; step < 15; ++step)
                for (const double beside : {-2.0, 0.0, 2.0}) {
                    const double angle = radians(degree + 0.5 + step);
                    const glm::dvec3 out = spherical_direction(angle, incident.phi);
                    const glm::dvec3 across(-std::sin(incident.phi), std::cos(incident.phi), 0);
                    const glm::dvec3 w = glm::normalize(out + radians(beside) * across);
                    expected += table.at(0, block, exits.bin(w), 0) / 45;
                }
            ++compared;
            // The bins are wider than the strip: a tenth of the intensity is allowed for that.
            disagreements +=
                std::abs(seen - expected) > 4 * std::sqrt(variance) + 0.1 * expected + 0.003;
        }
    EXPECT_LE(disagreements, 2) << "of " << compared;
    EXPECT_GT(std::accumulate(scan.intensity.begin(), scan.intensity.end(), 0.0), 1);
}

TEST(PlaneScan, ReachesTheAccuracyAskedForForAnyNumberOfThreads) {
    const FibreTracer tracer(tests::winding_fibres());
    const std::vector<IncidentDirection> incident{{Side::front, radians(20.0), 0},
                                                  {Side::back, radians(60.0), radians(90.0)}};
    std::vector<std::vector<PlaneScan>> runs;
    for (const int threads : {1, 2, 7}) {
        set_thread_count(threads);
        runs.push_back(scanned(tracer, incident, {.accuracy = 0.3, .seed = 3}));
    }
    set_thread_count(0);
    for (const std::vector<PlaneScan>& run : runs)
        for (size_t d = 0; d < 2; ++d) {
            EXPECT_EQ(run[d].intensity, runs[0][d].intensity);
            EXPECT_EQ(run[d].mean_error, runs[0][d].mean_error);
            EXPECT_LE(run[d].accuracy, 0.3);
            EXPECT_GT(run[d].accuracy, 0.25);
        }
    const auto other = scanned(tracer, incident, {.accuracy = 0.3, .seed = 4});
    EXPECT_NE(other[0].intensity, runs[0][0].intensity);
}

/// The claimed error against the spread of independent runs.
TEST(PlaneScan, ItsErrorIsTheSpreadOfItsRuns) {
    const FibreTracer tracer(tests::winding_fibres());
    const std::vector<IncidentDirection> incident{{Side::front, radians(20.0), radians(45.0)}};
    constexpr int kRuns = 24;
    std::vector<PlaneScan> runs;
    for (int seed = 0; seed < kRuns; ++seed)
        runs.push_back(scanned(tracer, incident,
                               {.accuracy = 1e-6, .max_paths = 10'000, .seed = uint64_t(seed)})[0]);
    double claimed = 0, actual = 0;
    for (size_t bin = 0; bin < runs[0].mean_intensity.size(); ++bin) {
        double sum = 0, sum2 = 0;
        for (const PlaneScan& run : runs) {
            claimed += square(run.mean_error[bin]) / kRuns;
            sum += run.mean_intensity[bin] / kRuns;
            sum2 += square(run.mean_intensity[bin]) / kRuns;
        }
        actual += (sum2 - sum * sum) * kRuns / (kRuns - 1);
    }
    // 238 bins × 23 degrees of freedom: the ratio's own spread is below 3 %.
    EXPECT_NEAR(std::sqrt(claimed / actual), 1, 0.06);
}

/// Thicker and thinner fibres in turn: the mean of what each sends, and the spread between them.
TEST(PlaneScan, AveragesRealisationsAndTellsTheirSpread) {
    std::vector<FibreTracer> same, different;
    for (const double radius : {4.6, 3.4}) {
        same.emplace_back(tests::fibre_stack(4, 10, 4, 2));
        different.emplace_back(tests::fibre_stack(4, 10, radius, 2));
    }
    const std::vector<IncidentDirection> incident{{Side::front, radians(30.0), 0}};
    const auto scan = [&](std::span<const FibreTracer> realisations, uint64_t paths) {
        return scan_planes(realisations, kDyed, Bands{}, incident,
                           {.accuracy = 1e-6, .max_paths = paths})[0];
    };
    const PlaneScan both = scan(different, 200'000);
    const PlaneScan each[] = {scan({&different[0], 1}, 100'000), scan({&different[1], 1}, 100'000)};
    EXPECT_FALSE(each[0].realisation_error);
    double excess = 0, variance = 0, difference2 = 0, total = 0;
    for (size_t bin = 0; bin < both.mean_intensity.size(); ++bin) {
        const double mean = 0.5 * (each[0].mean_intensity[bin] + each[1].mean_intensity[bin]);
        const double noise =
            0.25 * (square(each[0].mean_error[bin]) + square(each[1].mean_error[bin]));
        excess += square(both.mean_intensity[bin] - mean);
        variance += square(both.mean_error[bin]) + noise;
        difference2 +=
            square(each[0].mean_intensity[bin] - each[1].mean_intensity[bin]) - 4 * noise;
        total += mean;
    }
    EXPECT_LT(excess, 1.5 * variance); // of some fifty bins that see light
    // Of two values the variance of the mean is a quarter of their squared difference.
    const double expected =
        std::sqrt(static_cast<double>(both.mean_intensity.size()) * difference2 / 4) / total;
    EXPECT_GT(expected, 0.1);
    EXPECT_NEAR(both.realisation_error.value(), expected, 0.1 * expected);
    EXPECT_LT(scan(same, 200'000).realisation_error.value(), 0.5 * both.accuracy);
    EXPECT_EQ(scan(same, 3).realisation_error, 0);
}

TEST(PlaneScan, HonoursItsBoundsAndRefusesWhatHasNoMeaning) {
    const FibreTracer tracer(tests::fibre_stack(2, 12, 4.6, 2));
    const std::vector<IncidentDirection> incident{{Side::front, 0.5, 0}, {Side::front, 0.7, 0}};
    for (const uint64_t most : {1u, 5000u, 100'000u})
        for (const PlaneScan& scan :
             scanned(tracer, incident, {.accuracy = 1e-4, .max_paths = most}))
            EXPECT_EQ(scan.paths, most);
    double last = 0;
    const auto timed =
        scan_planes({&tracer, 1}, kDyed, Bands{}, incident, {.accuracy = 1e-4, .max_seconds = 0.2},
                    [&](const GoniophotometerProgress& state) {
                        EXPECT_GE(state.fraction, last);
                        last = state.fraction;
                    });
    EXPECT_GT(last, 0);
    EXPECT_GT(timed[1].paths, 0u);
    EXPECT_THROW(scanned(tracer, incident, {.accuracy = 0}), std::invalid_argument);
    EXPECT_THROW(scanned(tracer, incident, {.max_events = 0}), std::invalid_argument);
    EXPECT_TRUE(scanned(tracer, {}, {}).empty());
}

} // namespace
} // namespace rapport
