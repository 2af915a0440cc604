#include "vgsp/goniophotometer.h"

#include "tests/support/long_run.h"
#include "tests/support/stability.h"
#include "tests/support/union_of_disks.h"

#include <gtest/gtest.h>

// Fibres that touch, and that overlap by up to half their diameter, where the paper shifts light
// that leaves one fibre inside another back to the surface of the second.

namespace rapport {
namespace {

using tests::Shares;

const uint64_t kPaths = tests::long_run() ? 400'000 : 20'000;
constexpr double kTheta = radians(25.0);
const FibreOptics kClear{1.53, {0}, 0};

Shares across(const tests::ParallelFibres& fibres, const FibreOptics& optics = kClear) {
    const Shares shares = tests::measure_shares(fibres.assembly(), optics, {Side::front, kTheta, 0},
                                                {.paths = kPaths});
    tests::expect_sound(shares);
    return shares;
}
Shares grown_together(double overlap) {
    return tests::UnionOfDisks(tests::fibre_pair(overlap)).shares(kTheta, kPaths);
}

/// Touching fibres, and those a hair apart or a hair into each other, are alike, and are what glass
/// fibres are.
TEST(Overlap, TouchingFibresAreNoSpecialCase) {
    const Shares expected = grown_together(0);
    for (const double overlap : {-1e-3, -1e-9, 0.0, 1e-12, 1e-9, 1e-6, 1e-4}) {
        SCOPED_TRACE(testing::Message() << "overlap " << overlap);
        const Shares shares = across(tests::fibre_pair(overlap));
        EXPECT_LT(shares.capped, 1e-3);
        tests::expect_close(shares, expected);
    }
}

/// The error of the rule, against fibres grown together, stays below a bound that grows with the
/// overlap; no light is lost or made. It is worst at 15 to 20 %, where the two as one body send
/// light straight back.
TEST(Overlap, ItsErrorIsBounded) {
    double largest = 0;
    for (double overlap = 0; overlap < 0.51; overlap += 0.1) {
        SCOPED_TRACE(testing::Message() << "overlap " << overlap);
        const tests::ParallelFibres fibres = tests::fibre_pair(overlap);
        const Shares expected = grown_together(overlap), shares = across(fibres);
        EXPECT_EQ(shares.counts.overlaps > 0, overlap > 0);
        EXPECT_NEAR(shares.reflected, expected.reflected,
                    tests::overlap_error(overlap) + tests::noise_of_difference(shares, expected));
        largest = std::max(largest, std::abs(shares.reflected - expected.reflected));
        // Light that meets no fibre knows nothing of the rule.
        const double apart =
            2 * fibres.radius * (1 - overlap) * std::cos(tests::kPairTilt + kTheta);
        const double shadow = std::min(apart, 2 * fibres.radius) + 2 * fibres.radius;
        EXPECT_NEAR(shares.unscattered, 1 - shadow / (fibres.period * std::cos(kTheta)),
                    3.5 * shares.error());
    }
    EXPECT_GT(largest, 0.03) << "the comparison tells the rule from the truth";
}

/// With an index of 1 the rule moves nothing but counts both fibres in full: the share of light is
/// exp(−σ·(chord + chord)), whatever the overlap.
TEST(Overlap, EveryFibreAbsorbsAlongItsWholeChord) {
    const double sigma = 0.05;
    for (const double overlap : {0.0, 0.25, 0.5}) {
        const tests::ParallelFibres fibres = tests::fibre_pair(overlap);
        double expected = 0;
        constexpr int kRays = 100'000;
        for (int i = 0; i < kRays; ++i) {
            double depth = 0;
            for (const glm::dvec2& centre : fibres.centres)
                for (int period = -1; period <= 1; ++period) {
                    const double x = ((i + 0.5) / kRays - period) * fibres.period - centre.x;
                    const double off = x * std::cos(kTheta) + centre.y * std::sin(kTheta);
                    depth += 2 * sigma * safe_sqrt(square(fibres.radius) - off * off);
                }
            expected += std::exp(-depth) / kRays;
        }
        const Shares shares = across(fibres, {1, {sigma}, 0});
        EXPECT_NEAR(shares.unscattered, expected, 3.5 * 0.5 * shares.error()) << overlap;
    }
}

/// Layers pressed into one another.
TEST(Overlap, StacksKeepTheirLight) {
    for (double overlap = -0.1; overlap < 0.51; overlap += 0.1) {
        SCOPED_TRACE(testing::Message() << "overlap " << overlap);
        constexpr double kRadius = 5;
        const double pitch = 2 * kRadius * (1 - overlap);
        const std::vector<Shares> shares =
            tests::measure_shares(tests::fibre_stack(4, pitch, kRadius, 2), {1.53, {0}, 0},
                                  {{Side::front, radians(30.0), radians(20.0)},
                                   {Side::back, radians(75.0), radians(80.0)}},
                                  {.paths = kPaths / 2});
        for (const Shares& each : shares) {
            tests::expect_sound(each);
            EXPECT_LT(each.capped, 2e-3);
        }
    }
}

} // namespace
} // namespace rapport
