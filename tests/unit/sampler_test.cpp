#include "renderer/core/sampler.h"

#include "renderer/core/sobol.h"
#include "tests/support/statistics.h"

#include <algorithm>
#include <cmath>
#include <gtest/gtest.h>
#include <set>
#include <vector>

using namespace rapport;
using namespace rapport::tests;

namespace {

/// The 2-D points of one pixel: dimension pair `skip` of `count` samples of even numbers, or of odd
/// ones, from 2·first or 2·first + 1 on.
std::vector<glm::vec2> points(Sampler::Kind kind, uint64_t pixel, uint32_t first, uint32_t count,
                              int skip, uint32_t half = 0) {
    std::vector<glm::vec2> points;
    for (uint32_t i = first; i < first + count; ++i) {
        Sampler sampler(kind, 42, pixel, 2 * i + half);
        for (int d = 0; d < skip; ++d)
            sampler.next_2d();
        points.push_back(sampler.next_2d());
    }
    return points;
}

/// Whether each elementary box 2^-i × 2^-(log2_count - i) holds exactly one of the points.
bool is_stratified(const std::vector<glm::vec2>& points, int log2_count) {
    for (int i = 0; i <= log2_count; ++i) {
        std::set<uint32_t> boxes;
        for (const glm::vec2& p : points) {
            const auto x = static_cast<uint32_t>(std::ldexp(p.x, i));
            const auto y = static_cast<uint32_t>(std::ldexp(p.y, log2_count - i));
            boxes.insert(x << (log2_count - i) | y);
        }
        if (boxes.size() != points.size())
            return false;
    }
    return true;
}

} // namespace

TEST(Sobol, FirstPointsAreThePublishedOnes) {
    const double expected[][2] = {{0, 0},         {0.5, 0.5},     {0.25, 0.75},   {0.75, 0.25},
                                  {0.125, 0.625}, {0.625, 0.125}, {0.375, 0.375}, {0.875, 0.875}};
    for (uint32_t i = 0; i < 8; ++i) {
        EXPECT_EQ(sobol::reverse_bits(sobol::first_dimension(i)) * 0x1p-32, expected[i][0]) << i;
        EXPECT_EQ(sobol::reverse_bits(sobol::second_dimension(i)) * 0x1p-32, expected[i][1]) << i;
    }
}

TEST(Sobol, ScramblingIsABijectionThatLooksOnlyUpwards) { // bits are in reverse
    for (const uint32_t seed : {0u, 1u, 0xDEADBEEFu})
        for (int bits = 1; bits <= 10; ++bits) { // equal top bits keep equal ones
            std::set<uint32_t> tops;
            for (uint32_t top = 0; top < 1u << bits; ++top) {
                const uint32_t mask = (1u << bits) - 1;
                const uint32_t scrambled = sobol::owen_scramble(top, seed) & mask;
                EXPECT_EQ(scrambled, sobol::owen_scramble(top | 1u << 31, seed) & mask);
                tops.insert(scrambled);
            }
            EXPECT_EQ(tops.size(), size_t{1} << bits);
        }
}

TEST(Sampler, EveryPairOfDimensionsIsStratified) {
    for (const uint64_t pixel : {0ull, 1ull, 123456789012ull})
        for (const int skip : {0, 1, 5, 40})
            for (const int log2_count : {0, 2, 5, 8}) {
                const uint32_t count = 1u << log2_count;
                for (const uint32_t half : {0u, 1u}) {
                    EXPECT_TRUE(is_stratified(
                        points(Sampler::Kind::sobol, pixel, 0, count, skip, half), log2_count));
                    EXPECT_TRUE(is_stratified( // and so is every later block, as samples are added
                        points(Sampler::Kind::sobol, pixel, 3 * count, count, skip, half),
                        log2_count));
                }
                EXPECT_NE(points(Sampler::Kind::sobol, pixel, 0, count, skip, 0),
                          points(Sampler::Kind::sobol, pixel, 0, count, skip, 1));
            }
}

TEST(Sampler, RandomNumbersAreNotStratified) {
    for (const uint64_t pixel : {0, 1, 2})
        EXPECT_FALSE(is_stratified(points(Sampler::Kind::independent, pixel, 0, 256, 0), 8));
}

TEST(Sampler, SingleDimensionsAreStratified) {
    std::set<int> cells;
    for (uint32_t i = 0; i < 64; ++i) {
        Sampler sampler(Sampler::Kind::sobol, 1, 9, 2 * i);
        sampler.next_2d();
        cells.insert(static_cast<int>(64 * sampler.next_1d()));
    }
    EXPECT_EQ(cells.size(), 64u);
}

TEST(Sampler, IsAFunctionOfSeedPixelAndSample) {
    for (const Sampler::Kind kind : {Sampler::Kind::independent, Sampler::Kind::sobol}) {
        EXPECT_EQ(points(kind, 3, 0, 16, 2), points(kind, 3, 0, 16, 2));
        EXPECT_NE(points(kind, 3, 0, 16, 2), points(kind, 4, 0, 16, 2));
        EXPECT_NE(points(kind, 3, 0, 16, 2), points(kind, 3, 0, 16, 3));
        Sampler a(kind, 1, 0, 0), b(kind, 2, 0, 0);
        EXPECT_NE(a.next_2d(), b.next_2d());
    }
}

// Over pixels, the numbers of one sample are independent uniform ones: pairs of one dimension
// pair, and of the same axis in two dimension pairs.
TEST(Sampler, PixelsAndDimensionsAreIndependent) {
    constexpr int kPixels = 40000;
    const std::vector<double> expected(64, kPixels / 64.0);
    for (const Sampler::Kind kind : {Sampler::Kind::independent, Sampler::Kind::sobol}) {
        std::vector<double> within(64), across(64), later(64);
        for (uint64_t pixel = 0; pixel < kPixels; ++pixel) {
            Sampler sampler(kind, 5, pixel, 6);
            const glm::vec2 a = sampler.next_2d(), b = sampler.next_2d();
            Sampler next(kind, 5, pixel, 23);
            const glm::vec2 c = next.next_2d();
            for (const glm::vec2& p : {a, b, c}) {
                ASSERT_GE(std::min(p.x, p.y), 0);
                ASSERT_LT(std::max(p.x, p.y), 1);
            }
            ++within[static_cast<int>(8 * a.x) * 8 + static_cast<int>(8 * a.y)];
            ++across[static_cast<int>(8 * a.x) * 8 + static_cast<int>(8 * b.x)];
            ++later[static_cast<int>(8 * c.x) * 8 + static_cast<int>(8 * c.y)];
        }
        EXPECT_GT(chi_square_test(within, expected).p_value, sidak(0.001, 6));
        EXPECT_GT(chi_square_test(across, expected).p_value, sidak(0.001, 6));
        EXPECT_GT(chi_square_test(later, expected).p_value, sidak(0.001, 6));
    }
}

// What it is for: a smooth integral with far less error than by independent numbers.
TEST(Sampler, IntegratesSmoothFunctionsBetter) {
    const auto mean_square_error = [](Sampler::Kind kind) {
        RunningMoments errors;
        for (uint64_t pixel = 0; pixel < 200; ++pixel) {
            double sum = 0;
            for (const glm::vec2& p : points(kind, pixel, 0, 256, 1))
                sum += std::sin(3.0 * p.x) * p.y / 256;
            const double exact = (1 - std::cos(3.0)) / 3 / 2;
            errors.add((sum - exact) * (sum - exact));
        }
        return errors.mean();
    };
    EXPECT_LT(mean_square_error(Sampler::Kind::sobol),
              0.01 * mean_square_error(Sampler::Kind::independent));
}
