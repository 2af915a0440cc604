#include "renderer/core/warp.h"

#include "renderer/core/octahedral.h"
#include "renderer/core/rng.h"
#include "tests/support/statistics.h"

#include <gtest/gtest.h>
#include <vector>

using namespace rapport;
using namespace rapport::tests;

namespace {

constexpr int kSamples = 100000;
constexpr int kCells = 16; // per axis

/// p-value for `coordinates(u)` being uniform on [0, 1)² where `u` is.
template <class Coordinates> double uniformity(Coordinates coordinates) {
    std::vector<double> observed(kCells * kCells);
    const std::vector<double> expected(observed.size(), double(kSamples) / observed.size());
    CounterRng rng(7, Purpose::test, 0, 0);
    for (int i = 0; i < kSamples; ++i) {
        const double x = rng.uniform();
        const glm::dvec2 p = coordinates(glm::dvec2(x, rng.uniform()));
        const auto cell = [](double v) { return std::clamp(int(v * kCells), 0, kCells - 1); };
        ++observed[cell(p.x) * kCells + cell(p.y)];
    }
    return chi_square_test(observed, expected).p_value;
}

double turn(double x, double y) { return azimuth(glm::dvec3(x, y, 0)) / (2 * kPi); }

} // namespace

// A density is right where its cumulative coordinates are uniform: for the disk r² and azimuth,
// for the cosine hemisphere sin²θ, for sphere and cone the height.
TEST(Warp, CumulativeCoordinatesAreUniform) {
    const double alarm = sidak(0.001, 5);
    EXPECT_GT(uniformity([](glm::dvec2 u) {
                  const glm::dvec2 p = square_to_disk(u);
                  return glm::dvec2(dot(p, p), turn(p.x, p.y));
              }),
              alarm);
    EXPECT_GT(uniformity([](glm::dvec2 u) {
                  const glm::dvec3 w = square_to_cosine_hemisphere(u);
                  return glm::dvec2(1 - w.z * w.z, turn(w.x, w.y));
              }),
              alarm);
    EXPECT_GT(uniformity([](glm::dvec2 u) {
                  const glm::dvec3 w = square_to_uniform_sphere(u);
                  return glm::dvec2((w.z + 1) / 2, turn(w.x, w.y));
              }),
              alarm);
    EXPECT_GT(uniformity([](glm::dvec2 u) {
                  const glm::dvec3 w = square_to_uniform_cone(u, 0.01);
                  return glm::dvec2((1 - w.z) / 0.01, turn(w.x, w.y));
              }),
              alarm);
    EXPECT_GT(uniformity([](glm::dvec2 u) {
                  const glm::dvec3 b = square_to_triangle(u); // 1 - √ of what lies beyond c
                  return glm::dvec2((1 - b.z) * (1 - b.z), b.x / (b.x + b.y));
              }),
              alarm);
    // The wrong twin: the hemisphere's samples taken for uniform ones.
    EXPECT_LT(uniformity([](glm::dvec2 u) {
                  const glm::dvec3 w = square_to_cosine_hemisphere(u);
                  return glm::dvec2(w.z, turn(w.x, w.y));
              }),
              1e-6);
}

// The mean of 1/pdf over samples is the measure of the shape.
TEST(Warp, DensitiesAreThoseOfTheSamples) {
    EXPECT_NEAR(1 / disk_pdf<double>(), kPi, 1e-12);
    EXPECT_NEAR(1 / uniform_sphere_pdf<double>(), 4 * kPi, 1e-12);
    EXPECT_NEAR(1 / uniform_cone_pdf(1.0), 2 * kPi, 1e-12);
    EXPECT_NEAR(1 / uniform_cone_pdf(2.0), 4 * kPi, 1e-12);
    EXPECT_EQ(cosine_hemisphere_pdf(-0.5), 0);
    RunningMoments measure, square_of_cosine;
    CounterRng rng(7, Purpose::test, 1, 0);
    for (int i = 0; i < kSamples; ++i) {
        const double x = rng.uniform();
        const glm::dvec3 w = square_to_cosine_hemisphere(glm::dvec2(x, rng.uniform()));
        measure.add(w.z > 0.1 ? 1 / cosine_hemisphere_pdf(w.z) : 0);
        square_of_cosine.add(w.z * w.z);
    }
    EXPECT_NEAR(measure.mean(), 2 * kPi * 0.9, 4 * measure.standard_error());
    EXPECT_NEAR(square_of_cosine.mean(), 0.5, 4 * square_of_cosine.standard_error());
}

TEST(Warp, StaysOnItsShapeInFloatAtTheEdges) {
    const float below = std::nextafter(1.0f, 0.0f);
    for (const float x : {0.0f, 1e-30f, 0.25f, 0.5f, 0.75f, below})
        for (const float y : {0.0f, 1e-30f, 0.25f, 0.5f, 0.75f, below}) {
            const glm::vec2 u(x, y);
            EXPECT_LE(glm::length(square_to_disk(u)), 1 + 1e-6f);
            EXPECT_NEAR(glm::length(square_to_cosine_hemisphere(u)), 1, 1e-6);
            EXPECT_GT(cosine_hemisphere_pdf(square_to_cosine_hemisphere(u).z), 0);
            EXPECT_NEAR(glm::length(square_to_uniform_sphere(u)), 1, 1e-6);
            const glm::vec3 w = square_to_uniform_cone(u, 1e-5f); // half angle 0.256 degrees
            EXPECT_NEAR(glm::length(w), 1, 1e-6);
            EXPECT_NEAR(std::hypot(w.x, w.y), std::sqrt(2e-5f * x), 1e-7);
            const glm::vec3 b = square_to_triangle(u);
            EXPECT_GE(std::min({b.x, b.y, b.z}), 0);
            EXPECT_NEAR(b.x + b.y + b.z, 1, 1e-6);
        }
}

TEST(Octahedral, BothDirectionsAreInverse) {
    CounterRng rng(7, Purpose::test, 2, 0);
    for (int i = 0; i < 10000; ++i) {
        const double x = rng.uniform();
        const glm::dvec2 p(x, rng.uniform());
        const glm::dvec3 w = octahedral_to_sphere(p);
        EXPECT_NEAR(glm::length(w), 1, 1e-12);
        EXPECT_LT(glm::distance(sphere_to_octahedral(w), p), 1e-9);
        const glm::vec3 single(w);
        EXPECT_LT(glm::distance(octahedral_to_sphere(sphere_to_octahedral(single)), single), 2e-6f);
    }
}

TEST(Octahedral, KeepsAreas) {
    EXPECT_GT(uniformity([](glm::dvec2 u) {
                  const glm::dvec3 w = octahedral_to_sphere(u);
                  return glm::dvec2((w.z + 1) / 2, turn(w.x, w.y));
              }),
              0.001);
}

// As pbrt-v4 orients it: centre up, corners down, edges' middles on the horizon.
TEST(Octahedral, Orientation) {
    const auto expect = [](double x, double y, glm::dvec3 w) {
        EXPECT_LT(glm::distance(octahedral_to_sphere(glm::dvec2(x, y)), w), 1e-12) << x << " " << y;
    };
    expect(0.5, 0.5, {0, 0, 1});
    for (const double x : {0.0, 1.0})
        for (const double y : {0.0, 1.0})
            expect(x, y, {0, 0, -1});
    expect(1, 0.5, {1, 0, 0});
    expect(0, 0.5, {-1, 0, 0});
    expect(0.5, 1, {0, 1, 0});
    expect(0.5, 0, {0, -1, 0});
    for (const glm::dvec3 w :
         {glm::dvec3(1, 0, 0), glm::dvec3(0, -1, 0), glm::dvec3(0, 0, 1), glm::dvec3(0, 0, -1)})
        EXPECT_LT(glm::distance(octahedral_to_sphere(sphere_to_octahedral(w)), w), 1e-12);
}
