#include "renderer/integrator/sample_plan.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace rapport {
namespace {

constexpr int kLargestGrowth = 4;
constexpr double kMargin = 1.1; ///< more than the estimate, for one round too few costs another
constexpr double kMostSamples = 1 << 24;

size_t required(const Film& film) {
    return static_cast<size_t>(std::ceil(kTileShare * static_cast<double>(film.tiles().size())));
}

/// The λ for which the mean of min(bound, λ·√s) is `mean`; infinite where the bounds alone keep it.
double common_factor(const std::vector<double>& bounds, const std::vector<double>& roots,
                     double mean) {
    const auto mean_at = [&](double factor) {
        double sum = 0;
        for (size_t i = 0; i < bounds.size(); ++i)
            sum += std::min(bounds[i], factor * roots[i]);
        return sum / static_cast<double>(bounds.size());
    };
    const double largest = *std::ranges::max_element(roots);
    double low = 0, high = mean / std::max(largest, 1e-300);
    while (mean_at(high) < mean) {
        if (high > 1e30 * mean)
            return std::numeric_limits<double>::infinity();
        high *= 2;
    }
    for (int i = 0; i < 60; ++i) {
        const double middle = 0.5 * (low + high);
        (mean_at(middle) < mean ? low : high) = middle;
    }
    return low;
}

} // namespace

bool reaches(const Film& film, double error) {
    if (!(film.noise().relative() <= error))
        return false;
    const auto good = std::ranges::count_if(
        film.tiles(), [&](const Film::Tile& tile) { return film.noise(tile).relative() <= error; });
    return static_cast<size_t>(good) >= required(film);
}

std::vector<int> plan_samples(const Film& film, double error) {
    std::vector<int> plan;
    for (const Film::Tile& tile : film.tiles())
        plan.push_back(tile.samples);
    if (reaches(film, error))
        return plan;

    std::vector<Film::Noise> noise;
    std::vector<double> roots, needs;
    for (const Film::Tile& tile : film.tiles()) {
        noise.push_back(film.noise(tile));
        roots.push_back(std::sqrt(noise.back().variance * tile.samples));
        needs.push_back(noise.back().relative() * std::sqrt(tile.samples));
    }
    std::vector<double> order = needs;
    const auto last = order.begin() + static_cast<std::ptrdiff_t>(required(film) - 1);
    std::ranges::nth_element(order, last);

    std::vector<double> bounds;
    for (size_t i = 0; i < noise.size(); ++i)
        bounds.push_back(square(error * std::max(noise[i].mean, roots[i] / *last)));
    const double factor = common_factor(bounds, roots, square(error * film.noise().mean));
    for (size_t i = 0; i < plan.size(); ++i) {
        const double target = std::min(bounds[i], factor * roots[i]) / kMargin;
        const double samples = roots[i] > 0 ? square(roots[i]) / target : 0;
        const double most = std::min(static_cast<double>(kLargestGrowth) * plan[i], kMostSamples);
        plan[i] = std::max(plan[i], static_cast<int>(std::ceil(std::min(samples, most))));
    }
    return plan;
}

} // namespace rapport
