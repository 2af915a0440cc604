#include "vgsp/goniophotometer.h"

#include "tests/support/long_run.h"
#include "tests/support/union_of_disks.h"

#include <gtest/gtest.h>

// Fibres at the ends of what they can be made of: clear and black, hardly denser than air and as
// dense as diamond, and paths cut short.

namespace rapport {
namespace {

using tests::Shares;

const uint64_t kPaths = tests::long_run() ? 400'000 : 20'000;
const IncidentDirection kIncident{Side::front, radians(30.0), radians(20.0)};

Shares shares(const FibreOptics& optics, int max_events = 4096, uint64_t seed = 0) {
    return tests::measure_shares(tests::fibre_stack(4, 12, 4.6, 2), optics, kIncident,
                                 {.paths = kPaths, .max_events = max_events, .seed = seed});
}

TEST(Absorption, FromNoneToMoreThanLightCanCross) {
    const Shares clear = shares({1.53, {0}, 0});
    EXPECT_LT(clear.absorbed, 1e-6);
    EXPECT_NEAR(shares({1.53, {1e-300}, 0}).reflected, clear.reflected, 1e-6);
    double before = 0;
    for (double sigma = 1e-12; sigma < 1e13; sigma *= 10) {
        SCOPED_TRACE(testing::Message() << "σ " << sigma << "/µm");
        const Shares dyed = shares({1.53, {sigma}, 0});
        tests::expect_sound(dyed);
        // The roulette adds noise to what is absorbed, not bias.
        EXPECT_GE(dyed.absorbed, before - 3.5 * dyed.error());
        EXPECT_NEAR(dyed.absorbed, sigma < 1e-7 ? 0 : dyed.absorbed, 1e-3);
        before = dyed.absorbed;
    }
    // What a black fibre returns has never been inside one.
    const Shares black = shares({1.53, {1e6}, 0});
    for (const double sigma : {1e9, 1e100, 1e308}) {
        const Shares blacker = shares({1.53, {sigma}, 0});
        tests::expect_sound(blacker);
        EXPECT_EQ(blacker.reflected, black.reflected) << sigma;
        EXPECT_EQ(blacker.transmitted, black.transmitted) << sigma;
    }
    EXPECT_LT(black.reflected, 0.2 * clear.reflected);
    EXPECT_NEAR(black.unscattered, clear.unscattered, 3.5 * std::sqrt(2.0) * black.error());
}

Shares of_parallel_fibres(double index, double absorption) {
    return tests::measure_shares(tests::parallel_fibres().assembly(), {index, {absorption}, 0},
                                 {Side::front, kIncident.theta, 0}, {.paths = kPaths});
}
/// The same by asking every disk in double precision.
Shares of_disks(double index, double absorption) {
    return tests::UnionOfDisks(tests::parallel_fibres(), index, absorption)
        .shares(kIncident.theta, kPaths);
}

TEST(Absorption, IsWhatDoublePrecisionTells) {
    for (const double sigma : {1e-6, 1e-2, 1e-1, 1.0, 1e6}) {
        SCOPED_TRACE(testing::Message() << "σ " << sigma << "/µm");
        tests::expect_close(of_parallel_fibres(1.53, sigma), of_disks(1.53, sigma));
    }
    const Shares more = of_parallel_fibres(1.53, 1e-1), less = of_disks(1.53, 7e-2);
    EXPECT_GT(less.transmitted - more.transmitted, tests::noise_of_difference(more, less));
}

TEST(Absorption, AtTheSurfaceFromNoneToAll) {
    double before = shares({1.53, {0}, 0}).reflected;
    for (const double share : {1e-15, 1e-6, 0.01, 0.5, 0.999, 1 - 1e-16, 1.0}) {
        const Shares dull = shares({1.53, {0}, share});
        tests::expect_sound(dull);
        EXPECT_LE(dull.reflected, before + 3.5 * dull.error()) << share;
        before = dull.reflected;
    }
    EXPECT_EQ(before, 0);
}

/// The thinner the optical contrast, the more light goes on nearly as it came; at an index of 1 it
/// goes on exactly so, and is unscattered.
TEST(RefractiveIndex, FromAirToDiamond) {
    double before = -1;
    for (const double index :
         {1.0, 1 + 1e-15, 1 + 1e-9, 1.0001, 1.01, 1.1, 1.3, 1.53, 1.9, 2.5, 4.0}) {
        SCOPED_TRACE(testing::Message() << "index 1 + " << index - 1);
        const Shares each = shares({index, {0}, 0});
        tests::expect_sound(each);
        EXPECT_GE(each.reflected, before - 3.5 * each.error());
        EXPECT_LT(each.capped, 5e-3);
        if (index == 1) {
            EXPECT_EQ(each.unscattered, 1);
        } else if (index <= 1.0001) {
            // Total reflection at grazing hits, of a share ∝ √(n − 1), is all that goes back.
            EXPECT_LT(each.reflected, 0.01 + 2 * std::sqrt(index - 1));
            EXPECT_LT(each.unscattered, 0.9) << "all light that meets a fibre is scattered";
        }
        before = each.reflected;
    }
    EXPECT_GT(before, 0.5);
}

TEST(RefractiveIndex, IsWhatDoublePrecisionTells) {
    for (const double over_one : {1e-9, 1e-4, 1e-2, 0.3, 1.5, 3.0}) {
        SCOPED_TRACE(testing::Message() << "index 1 + " << over_one);
        tests::expect_close(of_parallel_fibres(1 + over_one, 0), of_disks(1 + over_one, 0));
    }
    const Shares more = of_parallel_fibres(2.5, 0), less = of_disks(2.2, 0);
    EXPECT_GT(more.reflected - less.reflected, tests::noise_of_difference(more, less));
}

/// From less than counts to facets that mostly stand upright, of any index.
TEST(Roughness, FromNoneToOne) {
    const Shares smooth = shares({1.53, {0}, 0});
    EXPECT_EQ(shares({1.53, {0}, 0, 1e-300}).reflected, smooth.reflected);
    for (const double roughness : {1e-6, 1e-4, 1e-2, 0.1, 0.3, 1.0}) {
        SCOPED_TRACE(testing::Message() << "roughness " << roughness);
        const Shares rough = shares({1.53, {0}, 0, roughness});
        tests::expect_sound(rough);
        EXPECT_LT(rough.capped, 5e-3);
        if (roughness <= 1e-4)
            tests::expect_close(rough, smooth, 1e-4);
        for (const double index : {1.0, 1 + 1e-12, 1.0001, 4.0})
            tests::expect_sound(shares({index, {0}, 0, roughness}));
    }
}

/// Same seed, same paths: a longer leash takes light out of `capped` and into the rest.
TEST(DepthCap, OnlyMovesCappedLight) {
    const Shares longest = shares({1.53, {0}, 0}, 1 << 15);
    double capped = 1;
    for (int cap = 1; cap <= 4096; cap *= 2) {
        SCOPED_TRACE(testing::Message() << "at most " << cap << " events");
        const Shares each = shares({1.53, {0}, 0}, cap);
        tests::expect_sound(each);
        EXPECT_LE(each.capped, capped);
        EXPECT_LE(each.reflected, longest.reflected + 1e-6);
        EXPECT_LE(each.transmitted, longest.transmitted + 1e-6);
        EXPECT_NEAR(longest.reflected + longest.transmitted - each.reflected - each.transmitted,
                    each.capped - longest.capped, 1e-5);
        EXPECT_EQ(each.unscattered, longest.unscattered);
        capped = each.capped;
        if (cap == 8) {
            EXPECT_GT(capped, 0.1);
        }
    }
    EXPECT_LT(capped, 1e-3);
}

} // namespace
} // namespace rapport
