#include "vgsp/fibre_boundary.h"

#include "tests/support/long_run.h"
#include "tests/support/statistics.h"

#include <functional>
#include <gtest/gtest.h>
#include <vector>

// A flat rough boundary, z up on its outer side, against what is known of it in closed form.

namespace rapport {
namespace {

constexpr double kIndex = 1.53;
const int kPaths = tests::long_run() ? 4'000'000 : 400'000;

using Boundary =
    std::function<BoundaryEvent(const glm::dvec3& direction, bool inside, CounterRng&)>;

Boundary rough(double roughness) {
    return [=](const glm::dvec3& direction, bool inside, CounterRng& rng) {
        return meet_rough_boundary(direction, {0, 0, 1}, inside, kIndex, roughness, rng);
    };
}

/// Wrong: one facet, and another if that sends the light to the wrong side, until it does not.
Boundary single_facet_resampled(double roughness) {
    return [=](const glm::dvec3& direction, bool inside, CounterRng& rng) {
        for (;;) {
            // By area, then by visibility.
            const double tangent2 = square(roughness) / (1 / rng.uniform() - 1);
            const glm::dvec3 facet =
                spherical_direction(std::atan(std::sqrt(tangent2)), 2 * kPi * rng.uniform());
            const double seen = glm::dot(direction, facet) * (inside ? 1 : -1);
            if (seen < rng.uniform())
                continue;
            const BoundaryEvent event =
                meet_boundary(direction, facet, inside, kIndex, rng.uniform());
            if ((event.direction.z > 0) == (inside == event.transmitted))
                return event;
        }
    };
}

/// A boundary between two media in equilibrium: from both sides comes light that is as strong from
/// all directions, n² times as strong inside. What leaves must be so too: of energy that is kept
/// and of reciprocity, the joint consequence.
tests::ChiSquareResult leaves_equilibrium(const Boundary& boundary) {
    constexpr int kCells = 20; // to a side, of equal flux: cos²θ is uniform
    std::vector<double> count(2 * kCells), expected(2 * kCells);
    for (int cell = 0; cell < 2 * kCells; ++cell)
        expected[cell] =
            kPaths / double(kCells) * (cell < kCells ? 1 : square(kIndex)) / (1 + square(kIndex));
    for (int k = 0; k < kPaths; ++k) {
        CounterRng rng(3, Purpose::test, 0, k);
        const bool inside = rng.uniform() * (1 + square(kIndex)) > 1;
        const double theta = std::acos(std::sqrt(rng.uniform()));
        glm::dvec3 direction = spherical_direction(theta, 2 * kPi * rng.uniform());
        direction.z *= inside ? 1 : -1;
        const BoundaryEvent event = boundary(direction, inside, rng);
        EXPECT_NEAR(glm::length(event.direction), 1, 1e-12);
        const bool leaves_inside = inside != event.transmitted;
        EXPECT_EQ(event.direction.z < 0, leaves_inside);
        const int cell = std::min(kCells - 1, static_cast<int>(kCells * square(event.direction.z)));
        ++count[cell + (leaves_inside ? kCells : 0)];
    }
    return tests::chi_square_test(count, expected);
}

TEST(RoughBoundary, LeavesLightInEquilibriumAsItIs) {
    for (const double roughness : {1e-4, 0.03, 0.3, 1.0})
        EXPECT_GT(leaves_equilibrium(rough(roughness)).p_value, 0.002) << roughness;
    EXPECT_LT(leaves_equilibrium(single_facet_resampled(0.3)).p_value, 1e-6);
}

/// The share of the light from `incident` (towards it, on the outer side) that a microsurface of
/// width α sends towards `out` by a single facet [1/sr] (B. Walter et al., "Microfacet Models for
/// Refraction through Rough Surfaces", 2007, equations 20, 21, 33; shadowing taken as 1, which it
/// is to a thousandth for the angles and widths here).
double single_facet_density(const glm::dvec3& incident, const glm::dvec3& out, double roughness) {
    const bool reflected = out.z > 0;
    glm::dvec3 facet = reflected ? incident + out : -(incident + kIndex * out);
    const double stretch = glm::length(facet);
    facet /= stretch;
    const double cos_incident = glm::dot(incident, facet), cos_out = glm::dot(out, facet);
    if (facet.z <= 0 || cos_incident <= 0 || (cos_out > 0) != reflected)
        return 0;
    const double cos2 = square(facet.z);
    const double normals = square(roughness) / (kPi * square(1 - cos2 + square(roughness) * cos2));
    const double reflectance = fresnel_dielectric(cos_incident, 1 / kIndex).reflectance;
    const double per_out = reflected
                               ? reflectance / (4 * cos_out)
                               : (1 - reflectance) * square(kIndex) * -cos_out / square(stretch);
    return normals * cos_incident / incident.z * per_out;
}

/// Counts in cells of |z| and |φ| on both sides, against that density at a finer grid's midpoints.
tests::ChiSquareResult single_facets(double roughness, double expected_roughness, int paths) {
    constexpr int kHeights = 100, kAzimuths = 30, kFiner = 12;
    const glm::dvec3 incident = spherical_direction(radians(30.0), kPi);
    std::vector<double> count(2 * kHeights * kAzimuths), expected = count;
    const auto cell = [&](const glm::dvec3& out) {
        const int height = std::min(kHeights - 1, static_cast<int>(kHeights * std::abs(out.z)));
        const int turn = static_cast<int>(kAzimuths * std::abs(std::atan2(out.y, out.x)) / kPi);
        return ((out.z > 0 ? 0 : kHeights) + height) * kAzimuths + std::min(kAzimuths - 1, turn);
    };
    for (const int side : {1, -1})
        for (int i = 0; i < kHeights * kFiner; ++i)
            for (int j = 0; j < kAzimuths * kFiner; ++j) {
                const double z = side * (i + 0.5) / (kHeights * kFiner);
                const double phi = kPi * (j + 0.5) / (kAzimuths * kFiner);
                const glm::dvec3 out = spherical_direction(std::acos(z), phi);
                expected[cell(out)] += single_facet_density(incident, out, expected_roughness) * 2 *
                                       paths * kPi / (kHeights * kFiner * kAzimuths * kFiner);
            }
    double sum = 0;
    for (const double each : expected)
        sum += each;
    EXPECT_NEAR(sum / paths, 1, 2e-3) << "the density is normalised but for second facets";
    for (double& each : expected)
        each *= paths / sum;
    for (int k = 0; k < paths; ++k) {
        CounterRng rng(4, Purpose::test, 0, k);
        ++count[cell(rough(roughness)(-incident, false, rng).direction)];
    }
    for (size_t i = 0; i < count.size(); ++i)
        if (expected[i] < 5) // where only second facets lead to, perhaps
            count[i] = expected[i] = 0;
    return tests::chi_square_test(count, expected);
}

TEST(RoughBoundary, HasTheLobesOfItsFacets) {
    // So few paths that those over a second facet, one in a thousand, do not show.
    constexpr int kFew = 40'000;
    const tests::ChiSquareResult result = single_facets(0.1, 0.1, kFew);
    EXPECT_GT(result.degrees, 50);
    EXPECT_GT(result.p_value, 0.002);
    EXPECT_LT(single_facets(0.1, 0.11, kFew).p_value, 1e-6) << "a lobe wider by a tenth";
}

/// The slopes' width shrinks, and with it the distance from the smooth boundary, in proportion.
TEST(RoughBoundary, BecomesSmooth) {
    const glm::dvec3 direction = -spherical_direction(radians(50.0), 1.0);
    for (const bool inside : {false, true}) {
        const glm::dvec3 from = inside ? glm::dvec3(0.6, 0, 0.8) : direction;
        const BoundaryEvent mirror = meet_boundary(from, {0, 0, 1}, inside, kIndex, 0);
        const BoundaryEvent refraction = meet_boundary(from, {0, 0, 1}, inside, kIndex, 0.99999999);
        ASSERT_TRUE(refraction.transmitted);
        const double cos_incident = std::abs(from.z);
        const double reflectance =
            fresnel_dielectric(cos_incident, inside ? kIndex : 1 / kIndex).reflectance;
        for (const double roughness : {1e-2, 1e-4, kLeastRoughness}) {
            constexpr int kCount = 20'000;
            double reflected = 0, near = 0;
            for (int k = 0; k < kCount; ++k) {
                CounterRng rng(5, Purpose::test, 0, k);
                const BoundaryEvent event = rough(roughness)(from, inside, rng);
                const BoundaryEvent& smooth = event.transmitted ? refraction : mirror;
                reflected += !event.transmitted;
                near += glm::distance(event.direction, smooth.direction) < 4 * roughness;
            }
            EXPECT_NEAR(reflected / kCount, reflectance,
                        3.5 * std::sqrt(reflectance * (1 - reflectance) / kCount) + roughness)
                << roughness;
            EXPECT_GT(near / kCount, 0.7) << roughness; // GGX has long tails
        }
    }
}

TEST(RoughBoundary, IsDefinedForAllDirections) {
    for (const double roughness : {kLeastRoughness, 1e-3, 0.2, 1.0})
        for (const double index : {1 + 1e-12, 1.0001, 1.53, 4.0})
            for (const bool inside : {false, true})
                for (const double degree : {0.0, 1e-9, 45.0, 89.9, 90 - 1e-9, 90.0, 90 + 1e-9})
                    for (int k = 0; k < 50; ++k) {
                        CounterRng rng(6, Purpose::test, 0, k);
                        const glm::dvec3 normal = spherical_direction(0.1 * k, 0.7 * k);
                        const auto frame = BasicFrame<double>::about(inside ? normal : -normal);
                        const glm::dvec3 direction =
                            frame.to_world(spherical_direction(radians(degree), 2.0));
                        const BoundaryEvent event =
                            meet_rough_boundary(direction, normal, inside, index, roughness, rng);
                        ASSERT_NEAR(glm::length(event.direction), 1, 1e-9);
                        const double outwards = glm::dot(event.direction, normal);
                        ASSERT_GT(inside == event.transmitted ? outwards : -outwards, -1e-12)
                            << roughness << ' ' << index << ' ' << degree;
                    }
}

TEST(RoughBoundary, OfIndexOneChangesNothing) {
    CounterRng rng(7, Purpose::test, 0, 0);
    const glm::dvec3 d = glm::normalize(glm::dvec3(1, 2, -3));
    const BoundaryEvent event = meet_rough_boundary(d, {0, 0, 1}, false, 1, 0.5, rng);
    EXPECT_TRUE(event.transmitted);
    EXPECT_EQ(event.direction, d);
}

} // namespace
} // namespace rapport
