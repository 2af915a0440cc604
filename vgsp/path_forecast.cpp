#include "vgsp/path_forecast.h"

#include <algorithm>
#include <array>

namespace rapport {

std::vector<uint8_t> PathForecast::regions(const BsdfTable& table, size_t direction) {
    // 8 × 8 cells of equal solid angles on each hemisphere: over y, and the angle round it.
    const auto eighth = [](double x) { return std::clamp(static_cast<int>(4 * (x + 1)), 0, 7); };
    const ExitBins exits = table.exits_of(direction);
    const size_t bins = table.exits.bins();
    std::vector<uint8_t> regions(2 * bins);
    for (size_t bin = 0; bin < bins; ++bin) {
        const glm::dvec3 w = exits.direction(bin);
        const int region = 8 * eighth(w.y) + eighth(std::atan2(w.x, w.z) / (kPi / 2));
        regions[bin] = static_cast<uint8_t>(region);
        regions[bins + bin] = static_cast<uint8_t>(64 + region);
    }
    return regions;
}

PathForecast::PathForecast(const PathTally& pilot, std::span<const uint8_t> regions) {
    const double n = static_cast<double>(pilot.paths()), total = pilot.total();
    const std::span<const double> omega = pilot.solid_angles(), squares = pilot.squares(),
                                  fourths = pilot.fourth_powers();
    std::array<double, kRegions> region_omega{}, region_squares{}, region_fourths{};
    for (size_t bin = 0; bin < omega.size(); ++bin) {
        region_omega[regions[bin]] += omega[bin];
        region_squares[regions[bin]] += squares[bin];
        region_fourths[regions[bin]] += fourths[bin];
    }
    // Of D = Σ_b E[w²]_b/Ω_b: its mean, what the pilot leaves open of it, and Σ_b E[w⁴]_b/Ω_b², the
    // variance that one path gives it. Then ε²·N = 4π(D − M)/E[w]², M = Σ_b E[w]_b²/Ω_b.
    double density = 0, own = 0, of_path = 0, peaks = 0, of_peaks = 0, square_mean = 0, unseen = 0;
    for (size_t bin = 0; bin < omega.size(); ++bin) {
        const size_t region = regions[bin];
        double squared = squares[bin] / n, variance = 0, fourth = 0;
        if (region_squares[region] > 0) {
            // A path of the region, as it counts in a sum of squares, and the paths to one of it.
            const double path = region_fourths[region] / region_squares[region];
            const double expected = omega[bin] * region_squares[region] / region_omega[region] / n;
            const double paths = n + path / expected, own_squared = squared;
            squared = std::max(squared, (squares[bin] + path) / paths);
            variance = path * squared / (squared > own_squared ? paths : n);
            fourth = path * squared;
        }
        density += squared / omega[bin];
        unseen += (squared - squares[bin] / n) / omega[bin];
        own += variance / square(omega[bin]);
        of_path += fourth / square(omega[bin]);
        const double mean = pilot.mean(bin);
        peaks += square(mean) / omega[bin];
        of_peaks += squared * square(mean / omega[bin]);
        square_mean += squared;
    }
    error_of_one_path = pilot.error_of_one_path() + 4 * kPi * unseen / square(total);
    // By the delta method; the influence of a path on M is 2·w·E[w]_b/Ω_b, and D, M and E[w] are
    // taken as independent.
    const double of_both = 4 * std::max(of_peaks - square(peaks), 0.0) / square(density - peaks) +
                           4 * std::max(square_mean / square(total) - 1, 0.0);
    own_variance = own / square(density - peaks) + of_both / n;
    variance_of_one_path = of_path / square(density - peaks) + of_both;
}

double PathForecast::margin(double paths, double sigmas, double pilots) const {
    return sigmas * std::sqrt(own_variance / pilots + variance_of_one_path / paths);
}

double PathForecast::paths_needed(double accuracy, double sigmas) const {
    // The more paths, the smaller the margin: from above, every step comes nearer to the number
    // that is just enough.
    const double ideal = error_of_one_path / square(accuracy);
    double paths = ideal * (1 + margin(ideal, sigmas));
    for (int i = 0; i < 20; ++i)
        paths = ideal * (1 + margin(paths, sigmas));
    return paths;
}

} // namespace rapport
