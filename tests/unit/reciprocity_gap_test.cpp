#include "materials/table/reciprocity.h"

#include "tests/support/synthetic_tables.h"

#include <gtest/gtest.h>
#include <random>

namespace rapport {
namespace {

bool reflected(const IncidentDirection& from, const glm::dvec3& out) {
    return (out.z > 0) == (from.side == Side::front);
}

/// One band, filled: three would take three times as long and tell the same.
BsdfTable filled(const tests::Intensity& intensity, bool back = true) {
    BsdfTable table = make_full_table(Bands::from_edges({400, 700}), true, back);
    tests::fill_table(table, intensity);
    return table;
}

/// Reflects by Lambert's law, and transmits more from the front than from the back by `excess`.
tests::Intensity dull(double excess) {
    return [excess](const IncidentDirection& from, const glm::dvec3& out, size_t) {
        if (reflected(from, out))
            return 0.4 / kPi * std::abs(out.z);
        return (0.3 + (from.side == Side::front ? 0.5 : -0.5) * excess) / kPi * std::abs(out.z);
    };
}

/// A satin whose f depends on the sum of the directions alone: reciprocal.
double satin(const IncidentDirection& from, const glm::dvec3& out, size_t) {
    if (!reflected(from, out))
        return 0.2 / kPi * std::abs(out.z);
    const glm::dvec3 sum = spherical_direction(from.theta, from.phi) + out;
    const double highlight = std::exp(-square(sum.x / 0.5) - square(sum.y / 0.25));
    return (0.3 / kPi + 0.5 * highlight) * std::abs(out.z);
}
/// Its twin, which is not.
double darkening_satin(const IncidentDirection& from, const glm::dvec3& out, size_t band) {
    return satin(from, out, band) * (0.4 + 0.6 * std::cos(from.theta));
}

/// As if `paths` had been counted from every direction.
BsdfTable counted(const tests::Intensity& intensity, double paths, unsigned seed) {
    BsdfTable table = filled(intensity);
    std::mt19937 random(seed);
    for (size_t d = 0; d < table.directions(); ++d) {
        const ExitBins exits = table.exits_of(d);
        double flux = 0, variance = 0;
        for (const int block : {0, 1})
            for (size_t bin = 0; bin < table.exits.bins(); ++bin) {
                const double solid_angle = exits.solid_angle(bin);
                float& value = table.at(d, block, bin, 0);
                flux += value * solid_angle;
                variance += value / paths;
                std::poisson_distribution<int> count(value * solid_angle * paths);
                value = static_cast<float>(count(random) / (paths * solid_angle));
            }
        table.accuracy[d] = static_cast<float>(std::sqrt(variance * 4 * kPi) / flux);
    }
    return table;
}

TEST(ReciprocityGap, IsTheClosedFormOfADullCloth) {
    // Half of the pairs of directions lie on different sides and differ by excess/π·cosθ_a·cosθ_b.
    // With E[cos²] = 1/3 and E[cos] = 1/2 the RMS difference is excess/(3√2·π), and the mean is
    // (0.4 + 0.3)/8π.
    for (const double excess : {0.1, 0.4}) {
        const auto gap = reciprocity_gap(filled(dull(excess)));
        ASSERT_TRUE(gap);
        EXPECT_NEAR(gap->gap / (excess / (3 * std::sqrt(2.0)) / (0.7 / 8)), 1, 0.01);
        EXPECT_GT(gap->error, 0);
        EXPECT_LT(gap->error, 0.2 * gap->gap);
    }
}

TEST(ReciprocityGap, TellsAReciprocalClothFromItsTwin) {
    const auto none = reciprocity_gap(filled(dull(0))), sharp = reciprocity_gap(filled(satin)),
               twin = reciprocity_gap(filled(darkening_satin));
    ASSERT_TRUE(none && sharp && twin);
    std::printf("dull %.4f, satin %.4f ± %.4f, its twin %.4f ± %.4f\n", none->gap, sharp->gap,
                sharp->error, twin->gap, twin->error);
    EXPECT_LT(none->gap, 0.05); // of points for cells, and of wide bins, as the header tells
    EXPECT_LT(sharp->gap, 0.07);
    EXPECT_GT(twin->gap - 4 * twin->error, sharp->gap);
}

TEST(ReciprocityGap, OfANoisyTableIsWhatItsNoiseMakes) {
    const auto exact = reciprocity_gap(filled(satin));
    ASSERT_TRUE(exact);
    for (const double paths : {2000.0, 50000.0}) {
        const auto gap = reciprocity_gap(counted(satin, paths, 1));
        const auto twin = reciprocity_gap(counted(darkening_satin, paths, 2));
        ASSERT_TRUE(gap && twin);
        std::printf("%.0f paths: gap %.4f ± %.4f of noise %.4f, the twin's %.4f of %.4f\n", paths,
                    gap->gap, gap->error, gap->noise, twin->gap, twin->noise);
        // The bins' slopes add to the noise that is told.
        const double ratio = gap->gap / std::hypot(gap->noise, exact->gap);
        EXPECT_GT(ratio, 0.97);
        EXPECT_LT(ratio, 1.1);
        EXPECT_GT(twin->gap, std::hypot(twin->noise, exact->gap) * ratio);
    }
}

TEST(ReciprocityGap, NeedsAGridAndLight) {
    EXPECT_FALSE(reciprocity_gap(make_partial_table(Bands{}, {{}, {Side::back, 0.5, 1}})));
    EXPECT_FALSE(reciprocity_gap(make_full_table(Bands{}, true, true)));
    const auto front = reciprocity_gap(filled(dull(0.4), false)); // whose excess has no counterpart
    ASSERT_TRUE(front);
    EXPECT_LT(front->gap, 0.05);
}

} // namespace
} // namespace rapport
