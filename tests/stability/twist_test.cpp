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
constexpr double kYarn = 90, kFibre = 14;

/// A plain weave whose outermost fibres are tilted by `tilt` against the axes of their yarns; S in
/// the weft where `opposed`.
Cloth twisted(double tilt, bool opposed = false) {
    YarnSpec yarn = tests::loose_yarn(kYarn, kFibre);
    yarn.section = YarnSection::twisted;
    yarn.twist_per_m = 1e6 * std::tan(tilt) / (kPi * (kYarn - kFibre));
    YarnSpec weft = yarn;
    if (opposed)
        weft.twist_per_m *= -1;
    return tests::cloth_of(named_weave("plain"), yarn, weft, 45, 45);
}

TEST(Twist, To45DegreesWithoutOverlapOrLoss) {
    for (const bool opposed : {false, true})
        for (const double tilt : {1.0, 15.0, 30.0, 45.0}) {
            SCOPED_TRACE(testing::Message() << "tilt " << tilt << "°");
            const MicroElement element = build_micro_element(twisted(radians(tilt), opposed));
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

/// Half a degree more twist changes little.
TEST(Twist, IsContinuous) {
    for (const double tilt : {5.0, 40.0}) {
        SCOPED_TRACE(testing::Message() << "tilt " << tilt << "°");
        const IncidentDirection incident{Side::front, radians(20.0), radians(10.0)};
        const auto shares = [&](double degree) {
            return tests::measure_shares(build_micro_element(twisted(radians(degree))).fibres,
                                         {1.53, {0}, 0}, incident, {.paths = kPaths});
        };
        tests::expect_close(shares(tilt), shares(tilt + 0.5), 0.01);
    }
}

} // namespace
} // namespace rapport
