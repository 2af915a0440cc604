#include "materials/table/exit_chart.h"

#include "materials/table/fast_chart.h"
#include "renderer/core/rng.h"

#include <gtest/gtest.h>

namespace rapport {
namespace {

glm::dvec3 random_direction(CounterRng& rng) {
    return spherical_direction(std::acos(rng.uniform()), 2 * kPi * rng.uniform());
}

/// The sine of its angle from the horizon of the axis.
double along(const glm::dvec3& w, ConeAxis axis) { return axis == ConeAxis::warp ? w.y : w.x; }

TEST(ExitChart, KeepsTheConeOfItsYarnsOnALineWhateverTheLight) {
    CounterRng rng(2, Purpose::test, 0, 0);
    for (const ConeAxis axis : {ConeAxis::warp, ConeAxis::weft})
        for (int i = 0; i < 1000; ++i) {
            const glm::dvec3 light = random_direction(rng);
            const double round = kPi * (rng.uniform() - 0.5), height = -along(light, axis);
            if (std::abs(height) > ExitChart::kFarthest)
                continue;
            const double across = std::sqrt(1 - square(height)) * std::sin(round);
            const double z = std::sqrt(1 - square(height)) * std::cos(round);
            const glm::dvec3 on_cone = axis == ConeAxis::warp ? glm::dvec3(across, height, z)
                                                              : glm::dvec3(height, across, z);
            const ChartPoint p = ExitChart(light, axis).point(on_cone);
            EXPECT_NEAR(p.u, 0, 1e-9);
            EXPECT_NEAR(p.v, round / (kPi / 2), 1e-9);
            const ConeAxis other = axis == ConeAxis::warp ? ConeAxis::weft : ConeAxis::warp;
            if (std::abs(along(light, other) + across) > 0.01) {
                EXPECT_GT(std::abs(ExitChart(light, other).point(on_cone).u), 0.004);
            }
        }
}

TEST(ExitChart, IsOneToOneAndItsAreaThatOfSolidAngle) {
    CounterRng rng(3, Purpose::test, 0, 0);
    constexpr double kStep = 1e-6;
    for (int i = 0; i < 1000; ++i) {
        const ExitChart chart(random_direction(rng), i % 2 ? ConeAxis::warp : ConeAxis::weft);
        const ChartPoint p{1.9 * rng.uniform() - 0.95, 1.9 * rng.uniform() - 0.95};
        const glm::dvec3 w = chart.direction(p);
        EXPECT_NEAR(glm::length(w), 1, 1e-12);
        EXPECT_GE(w.z, 0);
        const ChartPoint again = chart.point(w), below = chart.point({w.x, w.y, -w.z});
        EXPECT_NEAR(again.u, p.u, 1e-9);
        EXPECT_NEAR(again.v, p.v, 1e-9);
        EXPECT_EQ(below.u, again.u);
        if (std::abs(p.u) < 2 * kStep)
            continue; // astride the highlight, where the slope changes
        const glm::dvec3 along_u = chart.direction({p.u + kStep, p.v}) - w;
        const glm::dvec3 along_v = chart.direction({p.u, p.v + kStep}) - w;
        const double area = glm::length(glm::cross(along_u, along_v)) / square(kStep);
        EXPECT_NEAR(area * chart.density(p), 1, 1e-3);
    }
}

TEST(FastAngles, AreThoseOfTheLibrary) {
    CounterRng rng(4, Purpose::test, 0, 0);
    for (int i = 0; i < 10000; ++i) {
        const glm::vec3 eye(random_direction(rng)), light(random_direction(rng));
        const Float4 e = {eye.x, eye.y, std::abs(eye.z), 0};
        const Float4 angles = fast_angles_of(e, light.x, light.z);
        ASSERT_NEAR(angles[0], std::acos(double(e[2])), 1e-6);
        ASSERT_NEAR(angles[1], azimuth(glm::dvec3(eye)), 2.5e-6);
        ASSERT_NEAR(angles[2], std::atan2(double(light.x), std::abs(light.z)) / (kPi / 2), 2e-6);
        const Float4 turned = {angles[2], -0.3f, 0, 1};
        const Float4 sines = fast_sine(turned);
        for (int lane = 0; lane < 4; ++lane)
            ASSERT_NEAR(sines[lane], std::sin(turned[lane] * (kPi / 2)), 2e-7);
    }
}

Float4 fast_point(const FastChart& chart, const glm::vec3& w) {
    const Float4 vector = load_xyz(&w.x);
    return chart.point(vector, fast_angles_of(Float4{0, 0, 1, 0}, chart.across(vector), w.z)[2]).uv;
}

TEST(FastChart, AgreesWithTheExact) {
    CounterRng rng(4, Purpose::test, 0, 0);
    for (int i = 0; i < 10000; ++i) {
        const glm::dvec3 light = random_direction(rng), w = random_direction(rng);
        const ConeAxis axis = i % 2 ? ConeAxis::warp : ConeAxis::weft;
        const ExitChart exact(light, axis);
        const FastChart fast(Float4{float(light.x), float(light.y), float(light.z), 0}, axis);
        const ChartPoint p = exact.point(w);
        const Float4 q = fast_point(fast, glm::vec3(w));
        // At the ends of the axes a hemisphere is thin across the chart.
        const double thin =
            1e-5 / (1 - std::max(std::abs(along(light, axis)), std::abs(along(w, axis))));
        ASSERT_NEAR(q[0], p.u, thin);
        ASSERT_NEAR(q[1], p.v, 2.5e-6);
        const glm::dvec3 back(fast.direction(q));
        ASSERT_NEAR(glm::length(back), 1, 1e-6);
        ASSERT_NEAR(glm::distance(back, w), 0, 2e-3);
        if (std::abs(p.u) > thin) {
            ASSERT_NEAR(fast.density(q) / exact.density(p), 1, thin);
        }
    }
}

TEST(FastChart, EndsOfTheAxesAreSafe) {
    for (const glm::vec3 light :
         {glm::vec3(0, 1, 0), {0, -1, 0}, {1, 0, 0}, {0, 0, 1}, {0, 0, -1}, {-1, 0, 1e-30f}})
        for (const glm::vec3 w : {glm::vec3(0, 1, 0), {0, -1, 0}, {1, 0, 0}, {0, 0, 1}})
            for (const ConeAxis axis : {ConeAxis::warp, ConeAxis::weft}) {
                const FastChart chart(load_xyz(&light.x), axis);
                const Float4 p = fast_point(chart, w);
                EXPECT_LE(std::max(std::abs(p[0]), std::abs(p[1])), 1 + 1e-5f);
                EXPECT_GT(chart.density(p), 0);
                EXPECT_NEAR(glm::length(chart.direction(p)), 1, 1e-6);
            }
}

} // namespace
} // namespace rapport
