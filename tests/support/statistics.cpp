#include "tests/support/statistics.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>
#include <stdexcept>
#include <vector>

namespace rapport::tests {

ChiSquareResult chi_square_test(std::span<const double> observed, std::span<const double> expected,
                                double pool_below) {
    if (observed.size() != expected.size())
        throw std::invalid_argument("χ² test: observed and expected differ in length");
    ChiSquareResult result;
    std::vector<size_t> order(observed.size());
    std::iota(order.begin(), order.end(), size_t{0});
    std::ranges::stable_sort(order, {}, [&](size_t i) { return expected[i]; });

    std::vector<std::pair<double, double>> cells; // observed, expected
    std::pair<double, double> pool{0, 0};
    for (const size_t i : order) {
        if (!(expected[i] > 0)) {
            result.impossible |= observed[i] != 0;
            continue;
        }
        pool.first += observed[i];
        pool.second += expected[i];
        if (pool.second >= pool_below) {
            cells.push_back(pool);
            pool = {0, 0};
        }
    }
    if (pool.second > 0) { // too few in all for a pool of their own
        if (cells.empty())
            cells.push_back(pool);
        else {
            cells.back().first += pool.first;
            cells.back().second += pool.second;
        }
    }
    for (const auto& [seen, wanted] : cells)
        result.statistic += (seen - wanted) * (seen - wanted) / wanted;
    result.degrees = std::max(0, static_cast<int>(cells.size()) - 1);
    if (result.degrees > 0)
        result.p_value = upper_gamma(0.5 * result.degrees, 0.5 * result.statistic);
    if (result.impossible)
        result.p_value = 0;
    return result;
}

double sidak(double alpha, int tests) { return -std::expm1(std::log1p(-alpha) / tests); }

double normal_two_sided_p(double z) { return std::erfc(std::abs(z) / std::numbers::sqrt2); }

double upper_gamma(double a, double x) {
    if (!(a > 0) || !(x >= 0))
        throw std::invalid_argument("Q(a, x) needs a > 0 and x >= 0");
    if (x == 0)
        return 1;
    if (std::isinf(x))
        return 0;
    const double epsilon = std::numeric_limits<double>::epsilon();
    const double factor = std::exp(a * std::log(x) - x - std::lgamma(a));
    if (x < a + 1) {
        double term = 1 / a, sum = term;
        for (double n = a + 1; term > epsilon * sum; ++n)
            sum += term *= x / n;
        return 1 - factor * sum;
    }
    const double tiny = std::numeric_limits<double>::min() / epsilon;
    double b = x + 1 - a, c = 1 / tiny, d = 1 / b, fraction = d;
    for (double i = 1, change = 0; std::abs(change - 1) > epsilon; ++i) {
        const double numerator = -i * (i - a);
        b += 2;
        d = numerator * d + b;
        c = b + numerator / c;
        d = 1 / (std::abs(d) < tiny ? tiny : d);
        c = std::abs(c) < tiny ? tiny : c;
        change = c * d;
        fraction *= change;
    }
    return factor * fraction;
}

void RunningMoments::add(double value) {
    ++count_;
    const double difference = value - mean_;
    mean_ += difference / static_cast<double>(count_);
    sum_of_squares_ += difference * (value - mean_);
}

double RunningMoments::variance() const {
    return count_ > 1 ? sum_of_squares_ / static_cast<double>(count_ - 1) : 0;
}

double RunningMoments::standard_error() const {
    return count_ > 0 ? std::sqrt(variance() / static_cast<double>(count_)) : 0;
}

} // namespace rapport::tests
