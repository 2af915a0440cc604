#pragma once

#include <cstdint>
#include <span>

namespace rapport::tests {

/// Result of Pearson's χ² test of observed against expected counts.
struct ChiSquareResult {
    double statistic = 0;
    int degrees = 0;         ///< cells after pooling, less one; 0 = nothing to test (p_value 1)
    double p_value = 1;      ///< P(χ² ≥ statistic) if the expectation is true
    bool impossible = false; ///< something was observed where nothing is expected; p_value 0
};

/// Cells expected to hold fewer than `pool_below` are pooled, smallest first, until each pool
/// holds that many. Both spans have the same length and sum (up to noise); expected counts are
/// not negative.
ChiSquareResult chi_square_test(std::span<const double> observed, std::span<const double> expected,
                                double pool_below = 5);

/// The significance for each of `tests` independent tests at which all together raise a false
/// alarm with probability `alpha` (Šidák 1967).
double sidak(double alpha, int tests);

/// P(|Z| ≥ |z|) of a standard normal variable.
double normal_two_sided_p(double z);

/// Regularised upper incomplete gamma function Q(a, x), a > 0, x ≥ 0, to about 1e-13 (Numerical
/// Recipes, section 6.2: series below x = a + 1, Lentz's continued fraction above).
double upper_gamma(double a, double x);

/// Mean and variance of a stream of values (Welford 1962).
class RunningMoments {
  public:
    void add(double value);
    uint64_t count() const { return count_; }
    double mean() const { return mean_; }
    double variance() const;       ///< of one value, unbiased; 0 below two values
    double standard_error() const; ///< of the mean

  private:
    uint64_t count_ = 0;
    double mean_ = 0, sum_of_squares_ = 0;
};

} // namespace rapport::tests
