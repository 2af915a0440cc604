#include "vgsp/micro_element.h"

#include "tests/support/long_run.h"
#include "tests/support/scattering.h"
#include "tests/support/stability.h"

#include <gtest/gtest.h>

// Twist until the outermost fibres lie at 45° to their yarn.

namespace rapport {
namespace {

using tests::Shares;

const uint64_t kPaths = tests::long_run() ? 100'000 : 10'000;
TEST(Twist, To45DegreesWithoutOverlapOrLoss) {
    for (const bool opposed : {false, true})
        for (const double tilt : {1.0, 15.0, 30.0, 45.0}) {
            SCOPED_TRACE(testing::Message() << "tilt " << tilt << "°");
            const MicroElement element =
                build_micro_element(tests::tilted_cloth(radians(tilt), opposed));
            EXPECT_LT(element.overlap_fraction, 1e-3);
            EXPECT_LE(std::abs(element.twist_rounding_warp), 0.02);
            const std::vector<Shares> shares =
                tests::measure_shares(element.fibres, {1.53, {0}, 0},
                                      {{Side::front, radians(20.0), radians(10.0)},
                                       {Side::back, radians(70.0), radians(100.0)}},
                                      {.paths = kPaths / 2});
            for (const Shares& each : shares) {
                tests::expect_sound(each);
                EXPECT_LT(each.capped, 2e-3);
            }
        }
}

/// Fibres cut four times as finely scatter alike; those of a few segments do not.
TEST(Twist, NeedsNoFinerSegments) {
    const auto shares = [](double max_turn_degrees) {
        const MicroElement element = build_micro_element(tests::tilted_cloth(radians(45.0)),
                                                         {.max_turn_degrees = max_turn_degrees});
        return tests::measure_shares(element.fibres, {1.53, {0}, 0},
                                     {Side::front, radians(20.0), radians(10.0)},
                                     {.paths = 4 * kPaths});
    };
    const Shares fine = shares(0.25), coarse = shares(90);
    tests::expect_close(shares(1), fine);
    EXPECT_GT(fine.transmitted - coarse.transmitted, tests::noise_of_difference(fine, coarse));
}

/// Half a degree more twist changes little.
TEST(Twist, IsContinuous) {
    for (const double tilt : {5.0, 40.0}) {
        SCOPED_TRACE(testing::Message() << "tilt " << tilt << "°");
        const IncidentDirection incident{Side::front, radians(20.0), radians(10.0)};
        const auto shares = [&](double degree) {
            return tests::measure_shares(
                build_micro_element(tests::tilted_cloth(radians(degree))).fibres, {1.53, {0}, 0},
                incident, {.paths = kPaths});
        };
        tests::expect_close(shares(tilt), shares(tilt + 0.5), 0.01);
    }
}

} // namespace
} // namespace rapport
