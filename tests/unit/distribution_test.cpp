#include "renderer/core/distribution.h"

#include "renderer/core/rng.h"
#include "tests/support/statistics.h"

#include <cmath>
#include <gtest/gtest.h>
#include <limits>
#include <vector>

using namespace rapport;
using namespace rapport::tests;

TEST(Distribution1D, DensityIntegratesToOne) {
    const std::vector<float> weights{0, 3, 1, 0, 0, 4, 0.5f, 0};
    const Distribution1D distribution(weights);
    double integral = 0;
    for (size_t i = 0; i < weights.size(); ++i) {
        const double pdf = distribution.pdf((i + 0.5) / weights.size());
        EXPECT_NEAR(pdf, weights[i] / 8.5 * weights.size(), 1e-14);
        integral += pdf / weights.size();
    }
    EXPECT_NEAR(integral, 1, 1e-14);
    EXPECT_EQ(distribution.total(), 8.5);
}

TEST(Distribution1D, SamplesInvertTheCdfAndAvoidEmptyCells) {
    const std::vector<float> weights{0, 3, 1, 0, 0, 4, 0.5f, 0};
    const Distribution1D distribution(weights);
    double last = -1;
    for (int i = 0; i <= 10000; ++i) {
        const Distribution1D::Sample sample = distribution.sample(i / 10000.0); // 1 included
        EXPECT_GT(sample.pdf, 0);
        EXPECT_LT(sample.x, 1);
        EXPECT_GE(sample.x, last); // monotone, so that stratification survives
        EXPECT_GT(weights[static_cast<size_t>(sample.x * weights.size())], 0);
        EXPECT_EQ(sample.pdf, distribution.pdf(sample.x));
        last = sample.x;
    }
    EXPECT_NEAR(distribution.sample(0).x, 1.0 / 8, 1e-15);
    EXPECT_NEAR(distribution.sample(3 / 8.5 + 0.5 / 8.5).x, 2.5 / 8, 1e-14);
}

// Where the number lies at an edge of the cells, or as near as it can.
TEST(Distribution1D, NoRoundingLeadsIntoAnEmptyCell) {
    const auto check = [](const std::vector<double>& weights) {
        const Distribution1D distribution(weights);
        const auto count = static_cast<double>(weights.size());
        for (double i = 1; i < count; ++i)
            for (const double u :
                 {std::nextafter(i / count, 0.0), i / count, std::nextafter(i / count, 1.0)}) {
                const Distribution1D::Sample sample = distribution.sample(u);
                EXPECT_GT(sample.pdf, 0);
                EXPECT_EQ(sample.pdf, distribution.pdf(sample.x)) << u << " of " << count;
            }
    };
    for (const int count : {3, 49, 107, 1000, 4095}) {
        std::vector<double> weights(count);
        for (int i = 0; i < count; ++i)
            weights[i] = i % 2;
        check(weights);
    }
    constexpr int kCount = 1000;
    for (int i = 1; i < kCount; ++i) { // a thin cell from such an edge on, beside an empty one
        std::vector<double> thin(kCount);
        thin[0] = i;
        thin[2] = 1e-9;
        thin[3] = kCount - i - thin[2];
        check(thin);
    }
}

TEST(Distribution1D, WithoutWeightItIsUniform) {
    const Distribution1D distribution(std::vector<float>(5));
    EXPECT_EQ(distribution.total(), 0);
    for (const double u : {0.0, 0.3, 0.999}) {
        EXPECT_NEAR(distribution.sample(u).x, u, 1e-15);
        EXPECT_NEAR(distribution.sample(u).pdf, 1, 1e-14);
        EXPECT_NEAR(distribution.pdf(u), 1, 1e-14);
    }
}

TEST(Distribution1D, HoldsExtremes) {
    const float large = std::numeric_limits<float>::max();
    const Distribution1D distribution(std::vector<float>{large, large, 1, large});
    EXPECT_NEAR(distribution.pdf(0.1), 4.0 / 3, 1e-12);
    EXPECT_GT(distribution.sample(0.99999999).pdf, 0);
    const float nan = std::numeric_limits<float>::quiet_NaN();
    for (const std::vector<float>& wrong :
         {std::vector<float>{}, {1, -1}, {1, nan}, {std::numeric_limits<float>::infinity()}})
        EXPECT_THROW(Distribution1D{wrong}, std::invalid_argument);
}

TEST(Distribution2D, SamplesFollowTheDensity) {
    constexpr int kWidth = 6, kHeight = 4, kSamples = 100000;
    std::vector<float> weights(kWidth * kHeight);
    CounterRng rng(1, Purpose::test, 0, 0);
    for (float& weight : weights)
        weight = rng.uniform_float() < 0.3f ? 0 : rng.uniform_float();
    std::fill_n(weights.begin() + kWidth, kWidth, 0.0f); // a whole row
    const Distribution2D distribution(weights, kWidth, kHeight);

    std::vector<double> observed(weights.size()), expected(weights.size()), uniform;
    double integral = 0;
    for (int y = 0; y < kHeight; ++y)
        for (int x = 0; x < kWidth; ++x) {
            const size_t cell = y * kWidth + x;
            const double probability =
                distribution.pdf({(x + 0.5) / kWidth, (y + 0.5) / kHeight}) / weights.size();
            EXPECT_NEAR(probability, weights[cell] / distribution.total(), 1e-14);
            expected[cell] = probability * kSamples;
            integral += probability;
        }
    EXPECT_NEAR(integral, 1, 1e-14);
    for (int i = 0; i < kSamples; ++i) {
        const double u = rng.uniform();
        const Distribution2D::Sample sample = distribution.sample({u, rng.uniform()});
        EXPECT_NEAR(sample.pdf, distribution.pdf(sample.position), 1e-12);
        ++observed[static_cast<size_t>(sample.position.y * kHeight) * kWidth +
                   static_cast<size_t>(sample.position.x * kWidth)];
    }
    const ChiSquareResult result = chi_square_test(observed, expected);
    EXPECT_FALSE(result.impossible);
    EXPECT_GT(result.p_value, 0.001);

    // The wrong twin: rows and columns exchanged.
    std::vector<double> transposed(expected.size());
    for (int y = 0; y < kHeight; ++y)
        for (int x = 0; x < kWidth; ++x)
            transposed[x * kHeight + y] = expected[y * kWidth + x];
    EXPECT_LT(chi_square_test(observed, transposed).p_value, 1e-6);
}

TEST(Distribution2D, BlackImageIsUniform) {
    const std::vector<float> black(12);
    const Distribution2D distribution(black, 4, 3);
    EXPECT_NEAR(distribution.pdf({0.1, 0.9}), 1, 1e-14);
    EXPECT_NEAR(distribution.sample({0.25, 0.75}).position.y, 0.75, 1e-14);
    EXPECT_THROW(Distribution2D(black, 4, 4), std::invalid_argument);
    EXPECT_THROW(Distribution2D(black, 0, 0), std::invalid_argument);
}
