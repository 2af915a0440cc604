#include "tests/support/statistics.h"

#include "renderer/core/rng.h"

#include <algorithm>
#include <cmath>
#include <gtest/gtest.h>
#include <vector>

using namespace rapport;
using namespace rapport::tests;

// Q(1/2, x) = erfc(√x); Q(1, x) = e^-x; Q(n, x) = e^-x Σ_{k<n} x^k/k!.
TEST(UpperGamma, EqualsItsClosedForms) {
    for (const double x : {0.0, 1e-6, 0.1, 0.9, 1.5, 2.0, 7.0, 40.0, 300.0}) {
        EXPECT_NEAR(upper_gamma(0.5, x), std::erfc(std::sqrt(x)), 1e-13);
        EXPECT_NEAR(upper_gamma(1, x), std::exp(-x), 1e-13);
        for (const int n : {5, 50, 400}) {
            double sum = 0;
            for (int k = 0; k < n; ++k)
                sum += std::exp(-x + k * std::log(std::max(x, 1e-300)) - std::lgamma(k + 1.0));
            EXPECT_NEAR(upper_gamma(n, x), x > 0 ? sum : 1, 1e-11) << n << " " << x;
        }
    }
    EXPECT_THROW(upper_gamma(0, 1), std::invalid_argument);
    EXPECT_THROW(upper_gamma(1, std::nan("")), std::invalid_argument);
}

// The 5 % points printed in every table of the χ² distribution.
TEST(UpperGamma, GivesTheTabulatedChiSquarePoints) {
    EXPECT_NEAR(upper_gamma(0.5, 3.841459 / 2), 0.05, 1e-7);
    EXPECT_NEAR(upper_gamma(5, 18.307038 / 2), 0.05, 1e-7);
    EXPECT_NEAR(upper_gamma(50, 124.342113 / 2), 0.05, 1e-7);
}

TEST(ChiSquare, StatisticOfADie) {
    const std::vector<double> observed{5, 8, 9, 8, 10, 20}, expected(6, 10.0);
    const ChiSquareResult result = chi_square_test(observed, expected);
    EXPECT_NEAR(result.statistic, 13.4, 1e-12);
    EXPECT_EQ(result.degrees, 5);
    EXPECT_NEAR(result.p_value, 0.0199, 1e-4);
    EXPECT_FALSE(result.impossible);
}

TEST(ChiSquare, PoolsWhatIsRarelyExpected) {
    const std::vector<double> expected{100, 2, 2, 2, 1, 50};
    const std::vector<double> observed{100, 2, 2, 2, 1, 50};
    EXPECT_EQ(chi_square_test(observed, expected).degrees, 2); // 1 + 2 + 2, (2 +) 50, 100
    EXPECT_EQ(chi_square_test(observed, expected, 0.5).degrees, 5);
    const std::vector<double> few{1, 1};
    EXPECT_EQ(chi_square_test(few, few).degrees, 0);
    EXPECT_EQ(chi_square_test(few, few).p_value, 1);
}

TEST(ChiSquare, RefusesTheImpossible) {
    const std::vector<double> expected{50, 50, 0}, observed{50, 50, 1}, possible{52, 48, 0};
    EXPECT_TRUE(chi_square_test(observed, expected).impossible);
    EXPECT_EQ(chi_square_test(observed, expected).p_value, 0);
    EXPECT_FALSE(chi_square_test(possible, expected).impossible);
}

// Under a true expectation p-values are uniform; a die loaded by 10 % is found out.
TEST(ChiSquare, FalseAlarmsAndPower) {
    int alarms = 0, found = 0;
    constexpr int kRuns = 1000, kThrows = 6000;
    for (int run = 0; run < kRuns; ++run) {
        CounterRng rng(1, Purpose::test, run, 0);
        std::vector<double> fair(6), loaded(6), expected(6, kThrows / 6.0);
        for (int i = 0; i < kThrows; ++i) {
            ++fair[static_cast<int>(6 * rng.uniform())];
            const double u = 6.1 * rng.uniform();
            ++loaded[u < 6 ? static_cast<int>(u) : 0];
        }
        alarms += chi_square_test(fair, expected).p_value < 0.05;
        found += chi_square_test(loaded, expected).p_value < 0.05;
    }
    EXPECT_NEAR(alarms, 50, 4 * std::sqrt(50 * 0.95));
    EXPECT_GT(found, 0.4 * kRuns);
}

TEST(Sidak, AllTestsTogetherHaveTheLevelAskedFor) {
    EXPECT_NEAR(sidak(0.05, 1), 0.05, 1e-15);
    for (const int tests : {2, 10, 1000000})
        EXPECT_NEAR(-std::expm1(tests * std::log1p(-sidak(0.01, tests))), 0.01, 1e-12);
}

TEST(Normal, TabulatedQuantiles) {
    EXPECT_NEAR(normal_two_sided_p(1.959963985), 0.05, 1e-9);
    EXPECT_NEAR(normal_two_sided_p(-2.575829304), 0.01, 1e-9);
    EXPECT_EQ(normal_two_sided_p(0), 1);
    EXPECT_NEAR(normal_two_sided_p(6) / 1.973175e-9, 1, 1e-6);
}

TEST(RunningMoments, AreThoseOfTheSample) {
    RunningMoments moments;
    EXPECT_EQ(moments.variance(), 0);
    for (const double x : {2., 4., 4., 4., 5., 5., 7., 9.})
        moments.add(1e9 + x); // a large offset must not cost precision
    EXPECT_EQ(moments.count(), 8u);
    EXPECT_NEAR(moments.mean(), 1e9 + 5, 1e-6);
    EXPECT_NEAR(moments.variance(), 32.0 / 7, 1e-6);
    EXPECT_NEAR(moments.standard_error(), std::sqrt(32.0 / 7 / 8), 1e-6);
}
