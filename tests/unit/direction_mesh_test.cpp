#include "materials/table/direction_mesh.h"

#include "materials/table/fast_chart.h"
#include "renderer/core/rng.h"

#include <gtest/gtest.h>

namespace rapport {
namespace {

const glm::dvec3 kLight = spherical_direction(radians(52.0), radians(205.0));

TEST(DirectionMesh, CoversTheHemisphereExactly) {
    for (const auto& [columns, rows] : {std::pair(2, 2), {6, 1}, {24, 13}, {80, 512}})
        for (const glm::dvec3& light : {kLight, glm::dvec3(0, 0, 1)}) {
            const DirectionMesh mesh(columns, rows);
            const ExitBins exits(mesh, light);
            double sum = 0;
            for (size_t bin = 0; bin < mesh.bins(); ++bin)
                sum += exits.solid_angle(bin);
            EXPECT_NEAR(sum, 2 * kPi, 1e-10) << columns << " " << rows;
        }
}

TEST(DirectionMesh, IsFinestAtTheHighlightAndSymmetric) {
    const DirectionMesh mesh;
    ASSERT_EQ(mesh.bins(), static_cast<size_t>(mesh.columns() * mesh.rows()));
    for (const std::vector<double>* edges : {&mesh.u_edges(), &mesh.v_edges()}) {
        const size_t n = edges->size() - 1;
        EXPECT_EQ(edges->front(), -1);
        EXPECT_EQ(edges->at(n / 2), 0);
        for (size_t i = 0; i <= n; ++i)
            EXPECT_EQ(edges->at(i), -edges->at(n - i));
    }
    // What the README says of the bins, of light along the normal: round the yarns, across their
    // highlight, and at the horizon.
    const auto degrees = [](double low, double high) {
        return (std::asin(high) - std::asin(low)) * 180 / kPi;
    };
    EXPECT_NEAR(180.0 / mesh.rows(), 11, 0.5);
    EXPECT_NEAR(degrees(0, mesh.u_edges()[mesh.columns() / 2 + 1]), 1, 0.1);
    EXPECT_NEAR(degrees(mesh.u_edges()[mesh.columns() - 1], 1), 32, 0.5);
    const std::vector<double>& u = mesh.u_edges();
    for (size_t i = u.size() / 2 + 1; i + 1 < u.size(); ++i)
        EXPECT_GT(u[i + 1] - u[i], u[i] - u[i - 1]);
}

TEST(DirectionMesh, FindsEachBinFromItsInsideInBothPrecisions) {
    for (const int n : {2, 6, 24}) {
        const DirectionMesh mesh(n, n);
        const FastMesh fast(mesh);
        const ExitBins exits(mesh, kLight);
        for (size_t bin = 0; bin < mesh.bins(); ++bin)
            for (const double xi : {-0.999, 0.0, 0.999})
                for (const double eta : {-0.999, 0.5, 0.999}) {
                    const glm::dvec3 w = exits.direction(bin, xi, eta);
                    ASSERT_EQ(exits.bin(w), bin);
                    ASSERT_EQ(exits.bin({w.x, w.y, -w.z}), bin);
                    const Float4 share = {static_cast<float>(0.5 + 0.5 * xi),
                                          static_cast<float>(0.5 + 0.5 * eta)};
                    const FastMesh::Place place = fast.place(fast.point(bin / n, bin % n, share));
                    ASSERT_EQ(place.bin, bin);
                    ASSERT_NEAR(place.across[0], xi, 1e-3);
                    ASSERT_NEAR(place.across[1], eta, 1e-3);
                }
    }
}

TEST(DirectionMesh, EndsOfTheDomainHaveABin) {
    const DirectionMesh mesh;
    const ExitBins exits(mesh, kLight);
    for (const glm::dvec3& w : {glm::dvec3(0, 0, 1),
                                {1, 0, 0},
                                {-1, 0, 0},
                                {0, 1, 0},
                                {0, -1, -0.0},
                                {-0.0, 0.0, -1},
                                {1, -1e-320, 0}}) {
        EXPECT_LT(exits.bin(w), mesh.bins());
        EXPECT_EQ(exits.quarter(w) / 4, exits.bin(w));
    }
    const FastMesh fast(mesh);
    for (const float u : {-1.00001f, -1.0f, -0.0f, 0.0f, 1.0f, 1.00001f})
        for (const float v : {-1.0f, -1e-30f, 1.0f}) {
            const FastMesh::Place place = fast.place(Float4{u, v});
            EXPECT_LT(place.bin, mesh.bins());
            EXPECT_LE(std::max(std::abs(place.across[0]), std::abs(place.across[1])), 1);
        }
}

TEST(DirectionMesh, RefusesOddOrTooMany) {
    EXPECT_THROW(DirectionMesh(0, 4), std::invalid_argument);
    EXPECT_THROW(DirectionMesh(3, 4), std::invalid_argument);
    EXPECT_THROW(DirectionMesh(4, 0), std::invalid_argument);
    EXPECT_THROW(DirectionMesh(-2, 4), std::invalid_argument);
    EXPECT_THROW(DirectionMesh(4, DirectionMesh::kMost + 2), std::invalid_argument);
}

TEST(DirectionMesh, QuartersAreOfEqualSolidAngleAndInTheirBin) {
    // Uniform directions: a quarter each of those in a bin, four sigma.
    const DirectionMesh mesh(6, 5);
    const ExitBins exits(mesh, kLight, ConeAxis::weft);
    CounterRng rng(1, Purpose::test, 0, 0);
    std::vector<int> counts(4 * mesh.bins());
    constexpr int kDirections = 200'000;
    for (int i = 0; i < kDirections; ++i) {
        const glm::dvec3 w = spherical_direction(std::acos(rng.uniform()), 2 * kPi * rng.uniform());
        const size_t quarter = exits.quarter(w);
        ASSERT_EQ(quarter / 4, exits.bin(w));
        ++counts[quarter];
    }
    for (size_t quarter = 0; quarter < counts.size(); ++quarter) {
        const double expected = kDirections * exits.solid_angle(quarter / 4) / (4 * 2 * kPi);
        EXPECT_NEAR(counts[quarter], expected, 4.5 * std::sqrt(expected)) << quarter;
    }
}

} // namespace
} // namespace rapport
