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

const int kPaths = tests::long_run() ? 400'000 : 20'000;
constexpr double kRadius = 5, kPeriod = 40, kTheta = radians(25.0);
const IncidentDirection kAcross{Side::front, kTheta, 0};

/// Two fibres along y whose centres are a diameter less `overlap` of it apart, the line of centres
/// at 30° to the cloth.
std::vector<glm::dvec2> pair_of(double overlap) {
    const double half = kRadius * (1 - overlap);
    const glm::dvec2 along(std::cos(radians(30.0)), std::sin(radians(30.0)));
    return {{kPeriod / 2 - half * along.x, -half * along.y},
            {kPeriod / 2 + half * along.x, half * along.y}};
}

kernel::FibreAssembly fibres_at(const std::vector<glm::dvec2>& centres) {
    kernel::FibreAssembly assembly{{kPeriod, 20}, {}};
    for (const glm::dvec2& centre : centres)
        assembly.chains.push_back({{{centre.x, 0, centre.y}}, {0, 20, 0}, kRadius, 0});
    return assembly;
}

/// Touching fibres, and those a hair apart or a hair into each other, are alike, and are what glass
/// fibres are.
TEST(Overlap, TouchingFibresAreNoSpecialCase) {
    const double expected =
        tests::UnionOfDisks(pair_of(0), kRadius, kPeriod, 1.53).reflectance(kTheta, kPaths);
    for (const double overlap : {-1e-3, -1e-9, 0.0, 1e-12, 1e-9, 1e-6, 1e-4}) {
        SCOPED_TRACE(testing::Message() << "overlap " << overlap);
        const Shares shares = tests::measure_shares(fibres_at(pair_of(overlap)), {1.53, {0}, 0},
                                                    kAcross, {.paths = uint64_t(kPaths)});
        tests::expect_sound(shares);
        EXPECT_LT(shares.capped, 1e-3);
        EXPECT_NEAR(shares.reflected, expected, 3.5 * std::sqrt(2.0) * shares.error());
    }
}

/// The error of the rule, against fibres grown together, stays below a bound that grows with the
/// overlap; no light is lost or made. It is worst at 15 to 20 %, where the two as one body send
/// light straight back.
TEST(Overlap, ItsErrorIsBounded) {
    double largest = 0;
    for (double overlap = 0; overlap < 0.51; overlap += 0.1) {
        SCOPED_TRACE(testing::Message() << "overlap " << overlap);
        const double expected = tests::UnionOfDisks(pair_of(overlap), kRadius, kPeriod, 1.53)
                                    .reflectance(kTheta, kPaths);
        const Shares shares = tests::measure_shares(fibres_at(pair_of(overlap)), {1.53, {0}, 0},
                                                    kAcross, {.paths = uint64_t(kPaths)});
        tests::expect_sound(shares);
        EXPECT_EQ(shares.counts.overlaps > 0, overlap > 0);
        EXPECT_NEAR(shares.reflected, expected,
                    0.35 * overlap + 3.5 * std::sqrt(2.0) * shares.error());
        largest = std::max(largest, std::abs(shares.reflected - expected));
        // Light that meets no fibre knows nothing of the rule.
        const double length = kRadius * (1 - overlap), tilt = radians(30.0);
        const double across =
            2 * length *
            std::abs(std::cos(tilt) * std::cos(kTheta) - std::sin(tilt) * std::sin(kTheta));
        const double shadow = std::min(across, 2 * kRadius) + 2 * kRadius;
        EXPECT_NEAR(shares.unscattered, 1 - shadow / (kPeriod * std::cos(kTheta)),
                    3.5 * shares.error());
    }
    EXPECT_GT(largest, 0.03) << "the comparison tells the rule from the truth";
}

/// With an index of 1 the rule moves nothing but counts both fibres in full: the share of light is
/// exp(−σ·(chord + chord)), whatever the overlap.
TEST(Overlap, EveryFibreAbsorbsAlongItsWholeChord) {
    const double sigma = 0.05;
    for (const double overlap : {0.0, 0.25, 0.5}) {
        const std::vector<glm::dvec2> centres = pair_of(overlap);
        double expected = 0;
        constexpr int kRays = 100'000;
        for (int i = 0; i < kRays; ++i) {
            double depth = 0;
            for (const glm::dvec2& centre : centres)
                for (int period = -1; period <= 1; ++period) {
                    const double x = (i + 0.5) / kRays * kPeriod - centre.x - period * kPeriod;
                    const double off = x * std::cos(kTheta) + centre.y * std::sin(kTheta);
                    depth += 2 * sigma * safe_sqrt(kRadius * kRadius - off * off);
                }
            expected += std::exp(-depth) / kRays;
        }
        const Shares shares = tests::measure_shares(fibres_at(centres), {1, {sigma}, 0}, kAcross,
                                                    {.paths = uint64_t(kPaths)});
        tests::expect_sound(shares);
        EXPECT_NEAR(shares.unscattered, expected, 3.5 * 0.5 * shares.error()) << overlap;
    }
}

/// Layers pressed into one another.
TEST(Overlap, StacksKeepTheirLight) {
    for (double overlap = -0.1; overlap < 0.51; overlap += 0.1) {
        SCOPED_TRACE(testing::Message() << "overlap " << overlap);
        const double pitch = 2 * kRadius * (1 - overlap);
        const std::vector<Shares> shares =
            tests::measure_shares(tests::fibre_stack(4, pitch, kRadius, 2), {1.53, {0}, 0},
                                  {{Side::front, radians(30.0), radians(20.0)},
                                   {Side::back, radians(75.0), radians(80.0)}},
                                  {.paths = uint64_t(kPaths) / 2});
        for (const Shares& each : shares) {
            tests::expect_sound(each);
            EXPECT_LT(each.capped, 2e-3);
        }
    }
}

} // namespace
} // namespace rapport
