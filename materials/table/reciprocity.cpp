#include "materials/table/reciprocity.h"

#include "materials/table/bin_reconstruction.h"
#include "renderer/core/parallel.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <span>

namespace rapport {
namespace {

/// Places in a cell at which the table is looked up, along θ and φ.
constexpr int kSteps = 4;
using Places = std::array<glm::dvec3, kSteps * kSteps>;

/// The directions that one node of the grid of incidence stands for, the same on both sides.
struct Cell {
    double cosine_low, cosine_high, phi_low, phi_high;

    double solid_angle() const { return (cosine_high - cosine_low) * (phi_high - phi_low); }
    double projected() const {
        return 0.5 * (square(cosine_high) - square(cosine_low)) * (phi_high - phi_low);
    }
    /// Midpoints of equal solid angles.
    Places places() const {
        Places all;
        for (int i = 0; i < kSteps; ++i)
            for (int j = 0; j < kSteps; ++j)
                all[i * kSteps + j] = spherical_direction(
                    std::acos(std::lerp(cosine_low, cosine_high, (i + 0.5) / kSteps)),
                    std::lerp(phi_low, phi_high, (j + 0.5) / kSteps));
        return all;
    }
};

std::vector<Cell> cells_of(const BsdfTable& table) {
    const std::vector<double>&theta = table.grid_theta, &phi = table.grid_phi;
    std::vector<Cell> cells;
    for (size_t t = 0; t < theta.size(); ++t) {
        const double low = t == 0 ? 0 : 0.5 * (theta[t - 1] + theta[t]);
        const double high = t + 1 == theta.size() ? kPi / 2 : 0.5 * (theta[t] + theta[t + 1]);
        for (size_t p = 0; p < phi.size(); ++p) {
            const double before = p == 0 ? phi.back() - 2 * kPi : phi[p - 1];
            const double after = p + 1 == phi.size() ? 2 * kPi : phi[p + 1];
            cells.push_back(
                {std::cos(high), std::cos(low), 0.5 * (before + phi[p]), 0.5 * (phi[p] + after)});
        }
    }
    return cells;
}

/// Flux per solid angle into a cell from a direction, per incident flux [1/sr], and its variance.
struct Exchange {
    double mean = 0, variance = 0;
};

/// Of one direction into all cells, those of the side it comes from first.
std::vector<Exchange> exchanges(const BsdfTable& table, size_t direction,
                                const std::vector<Places>& cells) {
    const size_t bins = table.exits.bins(), bands = table.bands.count();
    const ExitBins exits = table.exits_of(direction);
    std::vector<double> solid_angle(bins);
    std::vector<Rgb> means(2 * bins, Rgb(0)); // grey: over the bands
    double flux = 0, intensities = 0;
    for (size_t bin = 0; bin < bins; ++bin)
        solid_angle[bin] = exits.solid_angle(bin);
    for (size_t i = 0; i < means.size(); ++i) {
        for (size_t band = 0; band < bands; ++band)
            means[i] += table.at(direction, static_cast<int>(i / bins), i % bins, band) /
                        static_cast<float>(bands);
        flux += double{means[i].g} * solid_angle[i % bins];
        intensities += means[i].g;
    }
    // ε² = Σ Ω·Var / 4π over (flux / 4π)², and Var = `of_count`·I/Ω of bins in which paths of like
    // weights are counted.
    const double of_count =
        intensities > 0 ? square(table.accuracy[direction] * flux) / (4 * kPi * intensities) : 0;
    std::vector<Exchange> found(2 * cells.size());
    for (const size_t block : {0, 1}) {
        const std::vector<BinPlane> planes =
            reconstruct(table.exits, exits, std::span(means).subspan(block * bins, bins));
        for (size_t c = 0; c < cells.size(); ++c) {
            Exchange& to = found[block * cells.size() + c];
            std::array<size_t, kSteps * kSteps> hit;
            for (size_t i = 0; i < hit.size(); ++i) {
                const auto place = table.exits.place(exits.chart().point(cells[c][i]));
                hit[i] = place.bin;
                to.mean += planes[place.bin]
                               .at(static_cast<float>(place.xi), static_cast<float>(place.eta))
                               .g /
                           double(hit.size());
            }
            // Places in one bin share its noise.
            for (const size_t bin : hit)
                to.variance += double(std::ranges::count(hit, bin)) / square(double(hit.size())) *
                               of_count * planes[bin].mean.g / solid_angle[bin];
        }
    }
    return found;
}

} // namespace

std::optional<ReciprocityGap> reciprocity_gap(const BsdfTable& table) {
    if (table.partial())
        return std::nullopt;
    const std::vector<Cell> cells = cells_of(table);
    const size_t n = cells.size();
    std::vector<Places> places;
    for (const Cell& cell : cells)
        places.push_back(cell.places());
    std::vector<std::vector<Exchange>> from(2 * n); // [side][cell]; empty where it is not measured
    parallel_for(2 * n, [&](size_t i) {
        if (const uint32_t direction = table.grid_index[i]; direction != BsdfTable::kAbsent)
            from[i] = exchanges(table, direction, places);
    });

    struct Sums {
        double squares = 0, variance = 0, mean = 0, weight = 0;
        void add(const Sums& s, double sign = 1) {
            squares += sign * s.squares;
            variance += sign * s.variance;
            mean += sign * s.mean;
            weight += sign * s.weight;
        }
        double relative(double of) const { return std::sqrt(std::max(of * weight, 0.0)) / mean; }
    };
    Sums total;
    std::vector<Sums> of_cell(2 * n); // of the pairs that it is one of
    for (size_t a = 0; a < 2 * n; ++a)
        for (size_t b = 0; b < a; ++b) {
            if (from[a].empty() || from[b].empty())
                continue;
            const size_t block = a / n == b / n ? 0 : n;
            const Exchange &ab = from[a][block + b % n], &ba = from[b][block + a % n];
            const Cell &at_a = cells[a % n], &at_b = cells[b % n];
            const double weight = at_a.solid_angle() * at_b.solid_angle();
            const double cosine_a = at_a.projected() / at_a.solid_angle();
            const double cosine_b = at_b.projected() / at_b.solid_angle();
            const Sums pair{weight * square(cosine_a * ab.mean - cosine_b * ba.mean),
                            weight *
                                (square(cosine_a) * ab.variance + square(cosine_b) * ba.variance),
                            weight * 0.5 * (cosine_a * ab.mean + cosine_b * ba.mean), weight};
            total.add(pair);
            of_cell[a].add(pair);
            of_cell[b].add(pair);
        }
    if (!(total.mean > 0))
        return std::nullopt;

    ReciprocityGap gap;
    gap.gap = total.relative(total.squares);
    gap.noise = total.relative(total.variance);
    // All cells at normal incidence share one direction: they are left out together.
    std::vector<Sums> of_direction(table.directions());
    for (size_t i = 0; i < 2 * n; ++i)
        if (table.grid_index[i] != BsdfTable::kAbsent)
            of_direction[table.grid_index[i]].add(of_cell[i]);
    double sum = 0, squares = 0;
    for (const Sums& left_out : of_direction) {
        Sums rest = total;
        rest.add(left_out, -1);
        const double difference = rest.relative(rest.squares) - gap.gap;
        sum += difference;
        squares += square(difference);
    }
    const double count = static_cast<double>(of_direction.size());
    gap.error = std::sqrt((count - 1) / count * std::max(squares - square(sum) / count, 0.0));
    return gap;
}

} // namespace rapport
