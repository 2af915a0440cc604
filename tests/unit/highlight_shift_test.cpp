#include "materials/table/highlight_shift.h"

#include "renderer/core/math.h"
#include "renderer/core/rng.h"

#include <gtest/gtest.h>

namespace rapport {
namespace {

Direction<float> random_direction(CounterRng& rng) {
    const auto w = spherical_direction(std::acos(1 - 2 * rng.uniform_float()),
                                       static_cast<float>(2 * kPi) * rng.uniform_float());
    return {w.x, w.y, w.z};
}

float angle_round_warp(const Direction<float>& w) { return std::atan2(w.x, w.z); }

TEST(HighlightShift, CarriesTheConeOfOneIncidenceOntoThatOfTheOther) {
    CounterRng rng(1, Purpose::test, 0, 0);
    for (int i = 0; i < 1000; ++i) {
        const auto from = random_direction(rng), to = random_direction(rng);
        Direction<float> w = random_direction(rng);
        const float turn = std::sqrt((1 - from.y * from.y) / (1 - w.y * w.y));
        w = {w.x * turn, -from.y, w.z * turn};
        const Direction<float> moved = along_warp(w, from, to).direction;
        EXPECT_NEAR(moved.y, -to.y, 1e-5);
        EXPECT_NEAR(angle_round_warp(moved), angle_round_warp(w), 1e-5);
    }
}

TEST(HighlightShift, IsOneToOneOnEachSideAndKeepsLength) {
    CounterRng rng(2, Purpose::test, 0, 0);
    for (int i = 0; i < 1000; ++i) {
        const auto from = random_direction(rng), to = random_direction(rng),
                   w = random_direction(rng);
        for (const auto move : {along_warp<float>, along_weft<float>}) {
            const auto [there, stretch] = move(w, from, to);
            EXPECT_NEAR(std::hypot(there.x, there.y, there.z), 1, 1e-5);
            EXPECT_EQ(there.z > 0, w.z > 0);
            const auto [back, shrink] = move(there, to, from);
            EXPECT_NEAR(back.x, w.x, 2e-3);
            EXPECT_NEAR(back.y, w.y, 2e-3);
            EXPECT_NEAR(stretch * shrink, 1, 1e-3);
        }
    }
}

TEST(HighlightShift, StretchIsThatOfSolidAngle) {
    // By differences in (y, angle round y), which chart the sphere by equal areas.
    CounterRng rng(3, Purpose::test, 0, 0);
    constexpr float kStep = 1e-3f;
    int compared = 0;
    for (int i = 0; i < 1000; ++i) {
        const auto from = random_direction(rng), to = random_direction(rng);
        const float y = 1.9f * rng.uniform_float() - 0.95f, angle = 3 * rng.uniform_float() - 1.5f;
        if (std::abs(y + from.y) < 2 * kStep)
            continue; // astride the highlight, where the slope changes
        const auto at = [&](float y) {
            const float cosine = std::sqrt(1 - y * y);
            return Direction<float>{cosine * std::sin(angle), y, cosine * std::cos(angle)};
        };
        const auto low = along_warp(at(y - kStep), from, to).direction,
                   high = along_warp(at(y + kStep), from, to).direction;
        const float stretch = along_warp(at(y), from, to).stretch;
        EXPECT_NEAR((high.y - low.y) / (2 * kStep), stretch, 1e-3 * stretch + 1e-3);
        EXPECT_NEAR(angle_round_warp(high), angle, 1e-4);
        ++compared;
    }
    EXPECT_GT(compared, 900);
}

TEST(HighlightShift, StandsStillFromAnIncidenceToItself) {
    CounterRng rng(4, Purpose::test, 0, 0);
    for (int i = 0; i < 1000; ++i) {
        const auto same = random_direction(rng), w = random_direction(rng);
        const auto [moved, stretch] = along_weft(w, same, same);
        EXPECT_NEAR(moved.x, w.x, 1e-6);
        EXPECT_NEAR(moved.y, w.y, 1e-6);
        EXPECT_EQ(stretch, 1);
    }
}

TEST(HighlightShift, FourAtOnceAreTheSameAsOne) {
    CounterRng rng(5, Purpose::test, 0, 0);
    const auto from = random_direction(rng), to = random_direction(rng), w = random_direction(rng);
    const auto four = [](const Direction<float>& d) {
        return Direction<Float4>{Float4(d.x), Float4(d.y), Float4(d.z)};
    };
    const auto one = along_warp(w, from, to);
    const auto lanes = along_warp(four(w), four(from), four(to));
    EXPECT_EQ(lanes.direction.x[2], one.direction.x);
    EXPECT_EQ(lanes.direction.y[0], one.direction.y);
    EXPECT_EQ(lanes.stretch[3], one.stretch);
}

TEST(HighlightShift, EndsOfTheAxesAreSafe) {
    // Unit vectors along the yarns, as incidence and as exits.
    for (const Direction<float> end : {Direction<float>{0, 1, 0}, {0, -1, 0}, {1, 0, 0}, {0, 0, 1}})
        for (const Direction<float> w : {Direction<float>{0, 1, 0}, {0, -1, 0}, {0, 0.6f, 0.8f}})
            for (const auto move : {along_warp<float>, along_weft<float>}) {
                const auto [moved, stretch] = move(w, end, {0.36f, 0.48f, 0.8f});
                EXPECT_TRUE(std::isfinite(moved.x) && std::isfinite(moved.y) &&
                            std::isfinite(moved.z) && std::isfinite(stretch));
            }
}

} // namespace
} // namespace rapport
