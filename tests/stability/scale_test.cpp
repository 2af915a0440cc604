#include "vgsp/goniophotometer.h"

#include "tests/support/long_run.h"
#include "tests/support/stability.h"

#include <gtest/gtest.h>

// The same cloth in another unit, elsewhere, or in a cell of another size.

namespace rapport {
namespace {

using kernel::FibreAssembly;
using tests::Shares;

const uint64_t kPaths = tests::long_run() ? 500'000 : 20'000;
const FibreOptics kClear{1.53, {0}, 0};
const IncidentDirection kIncident{Side::front, radians(40.0), radians(70.0)};

Shares shares(const FibreAssembly& assembly, uint64_t seed = 0) {
    const Shares result =
        tests::measure_shares(assembly, kClear, kIncident, {.paths = kPaths, .seed = seed});
    tests::expect_sound(result);
    EXPECT_LT(result.capped, 2e-3);
    return result;
}

TEST(Scale, FromAThousandthToAThousandTimes) {
    const Shares reference = shares(tests::winding_fibres());
    for (const double scale : {1e-3, 1e-2, 0.1, 10.0, 100.0, 1e3}) {
        SCOPED_TRACE(testing::Message() << "scale " << scale);
        tests::expect_close(shares(tests::scaled(tests::winding_fibres(), scale), 1), reference);
    }
}

TEST(Offset, OfTheCellWithinTheCloth) {
    const Shares reference = shares(tests::winding_fibres());
    for (const double offset : {1e-9, 1.0, 59.999999, 1e3, 1e5}) {
        SCOPED_TRACE(testing::Message() << "offset " << offset << " µm");
        tests::expect_close(shares(tests::winding_fibres({offset, -offset / 3, 0}), 1), reference);
    }
}

TEST(Offset, OfTheClothInHeight) {
    const Shares reference = shares(tests::winding_fibres());
    for (const double offset : {1.0, 100.0, 1e4, -1e4}) {
        SCOPED_TRACE(testing::Message() << "offset " << offset << " µm");
        tests::expect_close(shares(tests::winding_fibres({0, 0, offset}), 1), reference);
    }
}

/// A cell of more and more fibres of one size, down to a ten-thousandth of it.
TEST(FibreDiameter, OverTheCellFromATenthToATenThousandth) {
    constexpr double kPitch = 12, kRadius = 4.6;
    const Shares reference = shares(tests::fibre_stack(2, kPitch, kRadius, 1));
    for (const double ratio : {1e-1, 1e-2, 1e-3, 1e-4}) {
        SCOPED_TRACE(testing::Message() << "diameter over cell " << ratio);
        const int fibres = static_cast<int>(std::round(2 * kRadius / kPitch / ratio));
        tests::expect_close(shares(tests::fibre_stack(2, kPitch, kRadius, fibres), 1), reference);
    }
}

/// One fibre alone in a wide cell: what it takes out of the beam is its shadow.
TEST(FibreDiameter, OfALoneFibreOverTheCell) {
    constexpr double kRadius = 5;
    for (const double ratio : {1e-1, 1e-2, 1e-3, 1e-4}) {
        SCOPED_TRACE(testing::Message() << "diameter over cell " << ratio);
        const Shares each =
            tests::measure_shares(tests::single_fibre(kRadius, 2 * kRadius / ratio), kClear,
                                  IncidentDirection{}, {.paths = 20 * kPaths});
        tests::expect_sound(each);
        const double met = each.paths * (1 - each.unscattered);
        EXPECT_NEAR(met, each.paths * ratio,
                    3.5 * std::sqrt(each.paths * ratio) + 1e-6 * each.paths);
    }
}

} // namespace
} // namespace rapport
