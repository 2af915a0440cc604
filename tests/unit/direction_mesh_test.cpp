#include "materials/table/direction_mesh.h"

#include <gtest/gtest.h>
#include <numeric>

namespace rapport {
namespace {

double total_solid_angle(const DirectionMesh& mesh) {
    double sum = 0;
    for (size_t bin = 0; bin < mesh.bins(); ++bin)
        sum += mesh.solid_angle(bin);
    return sum;
}

TEST(DirectionMesh, CoversTheHemisphereExactly) {
    for (const int rings : {1, 2, 3, 9, 18, 45, 180})
        EXPECT_NEAR(total_solid_angle(DirectionMesh(rings)), 2 * kPi, 1e-12) << rings;
}

TEST(DirectionMesh, SolidAnglesAreThoseOfTheBounds) {
    const DirectionMesh mesh;
    for (size_t bin = 0; bin < mesh.bins(); ++bin) {
        const auto b = mesh.bounds(bin);
        const double area =
            (std::cos(b.theta_low) - std::cos(b.theta_high)) * (b.phi_high - b.phi_low);
        EXPECT_NEAR(mesh.solid_angle(bin) / area, 1, 1e-11) << bin;
    }
}

TEST(DirectionMesh, EighteenRingsOfNearlySquareBins) {
    const DirectionMesh mesh(18);
    EXPECT_EQ(mesh.rings(), 18);
    EXPECT_EQ(mesh.bins(), 824u);
    EXPECT_NEAR(mesh.ring_width(), radians(5.0), 1e-15);
    for (int ring = 0; ring < mesh.rings(); ++ring) {
        EXPECT_EQ(mesh.ring_bins(ring) % 4, 0u);
        const double width = std::sin((ring + 0.5) * mesh.ring_width()) * 2 * kPi /
                             static_cast<double>(mesh.ring_bins(ring));
        EXPECT_NEAR(width / mesh.ring_width(), 1, 0.25) << ring;
    }
}

TEST(DirectionMesh, FindsEachBinFromItsInside) {
    for (const int rings : {1, 3, 18}) {
        const DirectionMesh mesh(rings);
        for (size_t bin = 0; bin < mesh.bins(); ++bin) {
            const auto b = mesh.bounds(bin);
            EXPECT_LE(mesh.ring_first(mesh.ring_of(bin)), bin);
            for (const double s : {1e-9, 0.5, 1 - 1e-9})
                for (const double t : {1e-9, 0.5, 1 - 1e-9}) {
                    const double theta = std::lerp(b.theta_low, b.theta_high, s);
                    const double phi = std::lerp(b.phi_low, b.phi_high, t);
                    ASSERT_EQ(mesh.bin(theta, phi), bin);
                    glm::dvec3 w = spherical_direction(theta, phi);
                    ASSERT_EQ(mesh.bin(w), bin) << theta << " " << phi;
                    w.z = -w.z; // the other hemisphere has the same azimuths
                    ASSERT_EQ(mesh.bin(w), bin);
                }
        }
    }
}

TEST(DirectionMesh, EdgesOfTheDomainHaveABin) {
    const DirectionMesh mesh;
    const size_t last_ring = mesh.ring_first(17);
    EXPECT_EQ(mesh.bin(kPi / 2, 0), last_ring);
    EXPECT_EQ(mesh.bin(kPi / 2, 2 * kPi), last_ring);
    EXPECT_EQ(mesh.bin(0, 0), 0u);
    EXPECT_EQ(mesh.bin(-0.0, -0.0), 0u);
    EXPECT_EQ(mesh.bin(0.01, -1e-300), 3u); // just below 2π: the last bin of its ring
    EXPECT_EQ(mesh.bin(0.01, std::nextafter(2 * kPi, 0)), 3u);
    EXPECT_EQ(mesh.bin(0.01, -kPi / 4), 3u);
    EXPECT_EQ(mesh.bin(0.01, 9 * kPi / 4), 0u);
    EXPECT_EQ(mesh.bin(glm::dvec3(0, 0, 1)), 0u);
    EXPECT_EQ(mesh.bin(glm::dvec3(-0.0, -0.0, -1)), mesh.bin(0, kPi));
    EXPECT_EQ(mesh.bin(glm::dvec3(1, 0, 0)), last_ring);
    EXPECT_EQ(mesh.bin(glm::dvec3(1, -0.0, -0.0)), last_ring);
    EXPECT_EQ(mesh.bin(glm::dvec3(1, -1e-10, 0)), mesh.bins() - 1);
    EXPECT_EQ(mesh.bin(glm::dvec3(1, -1e-320, 0)), last_ring); // no double lies between it and 2π
    EXPECT_LT(mesh.bin(4.0, 1e6), mesh.bins());
}

TEST(DirectionMesh, MirrorsOntoItself) {
    const DirectionMesh mesh;
    for (size_t bin = 0; bin < mesh.bins(); ++bin) {
        const auto b = mesh.bounds(bin);
        const double theta = 0.5 * (b.theta_low + b.theta_high);
        const auto mirrored = mesh.bounds(mesh.bin(theta, -0.5 * (b.phi_low + b.phi_high)));
        EXPECT_NEAR(mirrored.phi_low, 2 * kPi - b.phi_high, 1e-12);
        const auto turned = mesh.bounds(mesh.bin(theta, 0.5 * (b.phi_low + b.phi_high) + kPi / 2));
        EXPECT_NEAR(std::remainder(turned.phi_low - b.phi_low - kPi / 2, 2 * kPi), 0, 1e-12);
    }
}

TEST(DirectionMesh, RefusesNoRings) {
    EXPECT_THROW(DirectionMesh(0), std::invalid_argument);
    EXPECT_THROW(DirectionMesh(-3), std::invalid_argument);
    EXPECT_THROW(DirectionMesh(DirectionMesh::kMaxRings + 1), std::invalid_argument);
}

TEST(DirectionMesh, QuartersAreOfEqualSolidAngleAndInTheirBin) {
    const DirectionMesh mesh;
    for (const size_t bin : {size_t{0}, size_t{3}, size_t{50}, mesh.bins() - 1}) {
        const auto b = mesh.bounds(bin);
        std::vector<int> counts(4);
        constexpr int kSteps = 20; // of cosθ and φ: all cells have one solid angle
        for (int i = 0; i < kSteps; ++i)
            for (int j = 0; j < kSteps; ++j) {
                const double cosine =
                    std::lerp(std::cos(b.theta_low), std::cos(b.theta_high), (i + 0.5) / kSteps);
                const double phi = std::lerp(b.phi_low, b.phi_high, (j + 0.5) / kSteps);
                const size_t quarter = mesh.quarter(spherical_direction(std::acos(cosine), phi));
                ASSERT_EQ(quarter / 4, bin);
                ASSERT_EQ(quarter % 4, 2 * (i >= kSteps / 2) + (j >= kSteps / 2));
                ++counts[quarter % 4];
            }
        EXPECT_EQ(counts, std::vector<int>(4, kSteps * kSteps / 4));
    }
    EXPECT_LT(mesh.quarter({1, -1e-300, 0}), 4 * mesh.bins());
}

} // namespace
} // namespace rapport
