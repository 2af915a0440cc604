#include "renderer/core/math.h"
#include "vgsp/fibre_scatter.h"
#include "vgsp/micro_element.h"

#include <gtest/gtest.h>

namespace rapport {
namespace {

using glm::dvec2;

/// Mean of f(field, rng) over fields drawn anew, with its standard error.
struct Estimate {
    double mean, error;
    bool agrees_with(double expected) const { return std::abs(mean - expected) < 4 * error; }
};

constexpr double kDeviation = 2, kAlong = 60, kAcross = 50, kPeriod = 2000;

template <class Function> Estimate over_fields(Function f) {
    constexpr int kFields = 400;
    double sum = 0, squares = 0;
    for (int k = 0; k < kFields; ++k) {
        CounterRng rng(1, Purpose::test, 0, k);
        const MigrationField field(kDeviation, kAlong, kAcross, kPeriod, rng);
        double value = 0;
        constexpr int kPlaces = 32;
        for (int i = 0; i < kPlaces; ++i)
            value += f(field, dvec2(rng.uniform(), rng.uniform()) * 80.0, kPeriod * rng.uniform());
        value /= kPlaces;
        sum += value;
        squares += value * value;
    }
    const double mean = sum / kFields;
    return {mean, std::sqrt((squares / kFields - mean * mean) / kFields)};
}

TEST(MigrationField, HasTheStandardDeviationAskedFor) {
    for (int axis : {0, 1}) {
        const Estimate variance = over_fields([&](const MigrationField& field, dvec2 p, double s) {
            return square(field.at(p, s)[axis]);
        });
        EXPECT_TRUE(variance.agrees_with(square(kDeviation))) << variance.mean;
        EXPECT_FALSE(variance.agrees_with(square(1.1 * kDeviation)));
    }
    const Estimate both = over_fields([](const MigrationField& field, dvec2 p, double s) {
        const dvec2 u = field.at(p, s);
        return u.x * u.y;
    });
    EXPECT_TRUE(both.agrees_with(0)) << both.mean;
}

TEST(MigrationField, IsCorrelatedAlongAndAcrossAsAsked) {
    for (double distance : {0.5, 1.0, 1.5, 3.0}) {
        const auto correlation = [&](double along, dvec2 across) {
            return over_fields([&](const MigrationField& field, dvec2 p, double s) {
                return dot(field.at(p, s), field.at(p + across, s + along)) /
                       (2 * square(kDeviation));
            });
        };
        const double expected = std::exp(-0.5 * square(distance));
        const double wrong = std::exp(-0.5 * square(distance / 1.3));
        const Estimate along = correlation(distance * kAlong, dvec2(0));
        EXPECT_TRUE(along.agrees_with(expected)) << distance << ' ' << along.mean;
        EXPECT_FALSE(along.agrees_with(wrong)) << distance;
        const Estimate across = correlation(0, distance * kAcross * dvec2(0.6, 0.8));
        EXPECT_TRUE(across.agrees_with(expected)) << distance << ' ' << across.mean;
        EXPECT_FALSE(across.agrees_with(wrong)) << distance;
    }
}

TEST(MigrationField, TurnsTangentsByDeviationOverLength) {
    const Estimate slope = over_fields([](const MigrationField& field, dvec2 p, double s) {
        return square((field.at(p, s + 0.5).x - field.at(p, s - 0.5).x));
    });
    EXPECT_TRUE(slope.agrees_with(square(kDeviation / kAlong))) << slope.mean;
    EXPECT_FALSE(slope.agrees_with(square(1.15 * kDeviation / kAlong)));
}

TEST(MigrationField, RepeatsWithItsPeriod) {
    CounterRng rng(3, Purpose::test, 0, 0);
    const MigrationField field(kDeviation, kAlong, kAcross, kPeriod, rng);
    for (double s : {0.0, 17.0, 1999.0}) {
        EXPECT_LT(length(field.at({3, 4}, s) - field.at({3, 4}, s + kPeriod)), 1e-9);
        EXPECT_GT(length(field.at({3, 4}, s) - field.at({3, 4}, s + kPeriod / 2)), 1e-3);
    }
}

/// A straight warp of loosely packed fibres, so that what is asked is not held back.
Cloth loose_cloth(const char* weave = "plain") {
    Cloth cloth;
    cloth.path = "loose.toml";
    cloth.draft = named_weave(weave);
    cloth.ends_per_cm = cloth.picks_per_cm = 40;
    cloth.crimp_balance = 0;
    for (YarnSpec* yarn : {&cloth.warp, &cloth.weft}) {
        yarn->fibres = 7;
        yarn->width_um = yarn->height_um = 120;
        yarn->fibre.diameter_um = 8;
        yarn->fibre.refractive_index = 1.5;
    }
    return cloth;
}

struct WarpStatistics {
    double deviation_degrees, diameter_mean, diameter_variation;
};

WarpStatistics warp_statistics(const Cloth& cloth) {
    double slope = 0, length = 0, diameter = 0, squares = 0;
    int fibres = 0;
    for (uint64_t seed = 0; seed < 4; ++seed) {
        MicroElementOptions options;
        options.seed = seed;
        const MicroElement element = build_micro_element(cloth, options);
        for (const kernel::FibreSegment& s : kernel::fibre_segments(element.fibres))
            if (s.kind == kWarpFibre) {
                slope += square(std::atan2(s.direction.z, s.direction.y)) * s.length;
                slope += square(std::atan2(s.direction.x, s.direction.y)) * s.length;
                length += 2 * s.length;
            }
        for (const kernel::FibreChain& chain : element.fibres.chains)
            if (chain.kind == kWarpFibre) {
                diameter += 2 * chain.radius;
                squares += square(2 * chain.radius);
                ++fibres;
            }
    }
    const double mean = diameter / fibres;
    return {degrees(std::sqrt(slope / length)), mean,
            std::sqrt(std::max(0.0, squares / fibres - mean * mean)) / mean};
}

TEST(Irregularity, RealisesTheDeviationOfTheTangents) {
    Cloth cloth = loose_cloth("satin 8/3");
    EXPECT_LT(warp_statistics(cloth).deviation_degrees, 1e-6);
    for (double asked : {1.5, 4.0}) {
        cloth.warp.irregularity.migration_um = 3;
        cloth.warp.irregularity.deviation_degrees = asked;
        EXPECT_NEAR(warp_statistics(cloth).deviation_degrees, asked, 0.05 * asked);
    }
}

TEST(Irregularity, RealisesTheVariationOfDiameters) {
    Cloth cloth = loose_cloth("satin 8/3");
    EXPECT_LT(warp_statistics(cloth).diameter_variation, 1e-6);
    cloth.warp.fibre.diameter_variation = 0.15;
    const WarpStatistics found = warp_statistics(cloth); // of 224 fibres: ± 0.007
    EXPECT_NEAR(found.diameter_variation, 0.15, 0.022);
    EXPECT_NEAR(found.diameter_mean, 8, 0.25);
}

TEST(Irregularity, KeepsFibresApartWhereThereIsRoom) {
    Cloth cloth = loose_cloth();
    for (YarnSpec* yarn : {&cloth.warp, &cloth.weft}) {
        yarn->fibres = 37;
        yarn->fibre.diameter_um = 12;
        yarn->fibre.diameter_variation = 0.1;
        yarn->irregularity = {.migration_um = 1.5, .deviation_degrees = 2, .spacing_jitter_um = 2};
    }
    const MicroElement roomy = build_micro_element(cloth);
    EXPECT_LT(roomy.overlap_fraction, 0.005);
    EXPECT_LT(roomy.thinned, 0.005);
    // Where there is none, they become thinner.
    for (YarnSpec* yarn : {&cloth.warp, &cloth.weft})
        yarn->fibre.diameter_um = 17, yarn->fibre.diameter_variation = 0.2;
    const MicroElement dense = build_micro_element(cloth);
    EXPECT_LT(dense.overlap_fraction, 0.005);
    EXPECT_GT(dense.thinned, 0.02);
}

TEST(Irregularity, StrayFibresRiseOverTheOthersOnly) {
    Cloth cloth = loose_cloth();
    cloth.crimp_balance = 0.5;
    const auto highest = [](const MicroElement& element) {
        double highest = 0;
        for (const kernel::FibreChain& chain : element.fibres.chains)
            for (const glm::dvec3& p : chain.points)
                highest = std::max(highest, p.z);
        return highest;
    };
    const double regular = highest(build_micro_element(cloth));
    cloth.warp.irregularity.stray_fibres = 1;
    const MicroElement element = build_micro_element(cloth);
    EXPECT_GT(highest(element), regular + 8); // by a fibre diameter
    EXPECT_LT(highest(element), regular + 6 * 8 + 1);
    EXPECT_LT(element.overlap_fraction, 0.005);
}

TEST(Irregularity, IsDecidedByTheSeedAndClosesWithinTheTurnAsked) {
    Cloth cloth = loose_cloth();
    for (YarnSpec* yarn : {&cloth.warp, &cloth.weft}) {
        yarn->section = YarnSection::twisted;
        yarn->twist_per_m = 500;
        yarn->irregularity = {
            .migration_um = 2, .deviation_degrees = 3, .spacing_jitter_um = 1, .stray_fibres = 0.3};
    }
    MicroElementOptions other;
    other.seed = 9;
    const MicroElement a = build_micro_element(cloth), b = build_micro_element(cloth),
                       c = build_micro_element(cloth, other);
    ASSERT_EQ(a.segments, b.segments);
    EXPECT_EQ(a.fibres.chains[5].points, b.fibres.chains[5].points);
    EXPECT_NE(a.fibres.chains[5].points, c.fibres.chains[5].points);
    double least = 1;
    const std::vector<kernel::FibreSegment> segments = kernel::fibre_segments(a.fibres);
    for (const kernel::FibreSegment& s : segments)
        least = std::min(least, dot(s.direction, segments[s.next].direction));
    EXPECT_LE(degrees(std::acos(least)), 1 + 1e-6);
}

} // namespace
} // namespace rapport
