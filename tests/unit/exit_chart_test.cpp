#include "materials/table/exit_chart.h"

#include "materials/table/fast_chart.h"
#include "renderer/core/rng.h"

#include <gtest/gtest.h>

namespace rapport {
namespace {

glm::dvec3 random_direction(CounterRng& rng) {
    return spherical_direction(std::acos(rng.uniform()), 2 * kPi * rng.uniform());
}

/// Light whose mirror direction becomes the origin.
glm::dvec3 random_light(CounterRng& rng) {
    for (;;) {
        const glm::dvec3 light = random_direction(rng);
        const double turn = std::atan2(std::abs(light.x), light.z) / (kPi / 2);
        if (std::max(std::abs(light.y), turn) < ExitChart::kFarthest)
            return light;
    }
}

TEST(ExitChart, HasTheMirrorDirectionInItsMiddle) {
    CounterRng rng(1, Purpose::test, 0, 0);
    for (int i = 0; i < 1000; ++i) {
        const glm::dvec3 light = random_light(rng);
        const ChartPoint p = ExitChart(light).point({-light.x, -light.y, -light.z});
        EXPECT_NEAR(p.u, 0, 1e-9);
        EXPECT_NEAR(p.v, 0, 1e-9);
    }
}

TEST(ExitChart, KeepsTheConeOfTheWarpOnALineWhateverTheLight) {
    CounterRng rng(2, Purpose::test, 0, 0);
    for (int i = 0; i < 1000; ++i) {
        const glm::dvec3 light = random_light(rng);
        const double round = kPi * (rng.uniform() - 0.5);
        const double across = std::sqrt(1 - square(light.y));
        const glm::dvec3 on_cone(across * std::sin(round), -light.y, across * std::cos(round));
        EXPECT_NEAR(ExitChart(light).point(on_cone).u, 0, 1e-9);
    }
}

/// The cone of the weft meets that line in the mirror direction and bends away from it with
/// distance: how far is stated here.
TEST(ExitChart, KeepsTheConeOfTheWeftNearALine) {
    for (const double theta : {20.0, 50.0})
        for (const double phi : {0.0, 30.0, 60.0}) {
            const glm::dvec3 light = spherical_direction(radians(theta), radians(phi));
            for (const double beside : {-0.1, -0.05, 0.05, 0.1}) {
                glm::dvec3 on_cone(-light.x, -light.y + beside, 0);
                on_cone.z = safe_sqrt(1 - glm::dot(on_cone, on_cone));
                EXPECT_LT(std::abs(ExitChart(light).point(on_cone).v), 1.5 * std::abs(beside))
                    << theta << " " << phi << " " << beside;
            }
        }
}

TEST(ExitChart, IsOneToOneAndItsAreaThatOfSolidAngle) {
    CounterRng rng(3, Purpose::test, 0, 0);
    constexpr double kStep = 1e-6;
    for (int i = 0; i < 1000; ++i) {
        const ExitChart chart(random_direction(rng));
        const ChartPoint p{1.9 * rng.uniform() - 0.95, 1.9 * rng.uniform() - 0.95};
        const glm::dvec3 w = chart.direction(p);
        EXPECT_NEAR(glm::length(w), 1, 1e-12);
        EXPECT_GE(w.z, 0);
        const ChartPoint again = chart.point(w), below = chart.point({w.x, w.y, -w.z});
        EXPECT_NEAR(again.u, p.u, 1e-9);
        EXPECT_NEAR(again.v, p.v, 1e-9);
        EXPECT_EQ(below.u, again.u);
        if (std::min(std::abs(p.u), std::abs(p.v)) < 2 * kStep)
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
        const Float4 angles = fast_angles_of(e, load_xyz(&light.x));
        const auto turns = [](const glm::dvec3& w) {
            return std::atan2(w.x, std::abs(w.z)) / (kPi / 2);
        };
        ASSERT_NEAR(angles[0], std::acos(double(e[2])), 1e-6);
        ASSERT_NEAR(angles[1], azimuth(glm::dvec3(eye)), 2.5e-6);
        ASSERT_NEAR(angles[2], turns(eye), 2e-6);
        ASSERT_NEAR(angles[3], turns(light), 2e-6);
        const Float4 turned = {angles[2], angles[3], 0, 1};
        const Float4 sines = fast_sine(turned);
        for (int lane = 0; lane < 4; ++lane)
            ASSERT_NEAR(sines[lane], std::sin(turned[lane] * (kPi / 2)), 2e-7);
    }
}

FastChart fast_chart(const glm::vec3& light) {
    const Float4 e = {light.x, light.y, std::abs(light.z), 0};
    return FastChart(light.y, fast_angles_of(e, e)[2]);
}

Float4 fast_point(const FastChart& chart, const glm::vec3& w) {
    const Float4 e = {w.x, w.y, std::abs(w.z), 0};
    return chart.point(w.y, fast_angles_of(e, e)[3]).uv;
}

TEST(FastChart, AgreesWithTheExact) {
    CounterRng rng(4, Purpose::test, 0, 0);
    for (int i = 0; i < 10000; ++i) {
        const glm::dvec3 light = random_direction(rng), w = random_direction(rng);
        const ExitChart exact(light);
        const FastChart fast = fast_chart(glm::vec3(light));
        const ChartPoint p = exact.point(w);
        const Float4 q = fast_point(fast, glm::vec3(w));
        // At the ends of the axes a hemisphere is thin across the chart.
        const double thin = 1e-5 / (1 - std::max(std::abs(light.y), std::abs(w.y)));
        ASSERT_NEAR(q[0], p.u, thin);
        ASSERT_NEAR(q[1], p.v, thin + 1e-5 / light.z);
        const glm::dvec3 back(fast.direction(q));
        ASSERT_NEAR(glm::length(back), 1, 1e-6);
        ASSERT_NEAR(glm::distance(back, w), 0, 2e-3);
        if (std::min(std::abs(p.u), std::abs(p.v)) > thin + 1e-5 / light.z) {
            ASSERT_NEAR(fast.density(q) / exact.density(p), 1, thin + 1e-5 / light.z);
        }
    }
}

TEST(FastChart, EndsOfTheAxesAreSafe) {
    for (const glm::vec3 light :
         {glm::vec3(0, 1, 0), {0, -1, 0}, {1, 0, 0}, {0, 0, 1}, {0, 0, -1}, {-1, 0, 1e-30f}})
        for (const glm::vec3 w : {glm::vec3(0, 1, 0), {0, -1, 0}, {1, 0, 0}, {0, 0, 1}}) {
            const FastChart chart = fast_chart(light);
            const Float4 p = fast_point(chart, w);
            EXPECT_LE(std::max(std::abs(p[0]), std::abs(p[1])), 1 + 1e-5f);
            EXPECT_GT(chart.density(p), 0);
            EXPECT_NEAR(glm::length(chart.direction(p)), 1, 1e-6);
        }
}

} // namespace
} // namespace rapport
