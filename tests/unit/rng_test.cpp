#include "renderer/core/rng.h"
#include "tests/support/statistics.h"

#include <cmath>
#include <gtest/gtest.h>
#include <set>
#include <vector>

using namespace rapport;
using namespace rapport::tests;

// Known answers of Philox4x32-10 from the Random123 distribution (kat_vectors).
TEST(CounterRng, IsPhilox) {
    // seed 0 and purpose 0 give key 0; sample 0 and index 0 give counter 0.
    CounterRng rng(0, Purpose::pixel, 0, 0);
    for (const uint32_t expected : {0x6627E8D5u, 0xE169C58Du, 0xBC57AC4Cu, 0x9B00DBD8u})
        EXPECT_EQ(rng.bits(), expected);
}

TEST(CounterRng, IsAFunctionOfItsArguments) {
    CounterRng a(1, Purpose::test, 5, 7), b(1, Purpose::test, 5, 7);
    for (int i = 0; i < 100; ++i)
        EXPECT_EQ(a.bits(), b.bits());
    // Every argument matters, in its high half too.
    const uint64_t high = uint64_t{1} << 32;
    std::set<std::pair<uint32_t, uint32_t>> firsts;
    for (const uint64_t seed : {uint64_t{0}, uint64_t{1}, high})
        for (const Purpose purpose : {Purpose::pixel, Purpose::incident_path, Purpose::walk})
            for (const uint64_t index : {uint64_t{0}, uint64_t{1}, high})
                for (const uint64_t sample : {uint64_t{0}, uint64_t{1}, high}) {
                    CounterRng rng(seed, purpose, index, sample);
                    const uint32_t first = rng.bits();
                    firsts.insert({first, rng.bits()});
                }
    EXPECT_EQ(firsts.size(), 81u);
}

TEST(CounterRng, IsUniformAlongAndAcrossStreams) {
    constexpr int kCells = 256, kDraws = 200000;
    const std::vector<double> expected(kCells, double(kDraws) / kCells);
    std::vector<double> along(kCells), across(kCells), pairs(kCells), skewed(kCells);
    CounterRng stream(11, Purpose::test, 0, 0);
    for (int i = 0; i < kDraws; ++i) {
        const double u = stream.uniform();
        ASSERT_GT(u, 0);
        ASSERT_LT(u, 1);
        ++along[static_cast<int>(kCells * u)];
        ++skewed[static_cast<int>(kCells * std::pow(u, 1.03))];
        CounterRng other(11, Purpose::test, i / 100, i % 100);
        const float x = other.uniform_float(), y = other.uniform_float();
        ASSERT_GE(x, 0);
        ASSERT_LT(x, 1);
        ++across[static_cast<int>(kCells * x)];
        ++pairs[static_cast<int>(16 * x) * 16 + static_cast<int>(16 * y)];
    }
    EXPECT_GT(chi_square_test(along, expected).p_value, sidak(0.001, 3));
    EXPECT_GT(chi_square_test(across, expected).p_value, sidak(0.001, 3));
    EXPECT_GT(chi_square_test(pairs, expected).p_value, sidak(0.001, 3));
    EXPECT_LT(chi_square_test(skewed, expected).p_value, 1e-6); // the wrong twin
}
