#include "materials/table/bin_reconstruction.h"

#include <algorithm>
#include <cmath>

namespace rapport {
namespace {

/// A bin in a line of bins across a hemisphere; widths in any one unit.
struct LinePart {
    double mean, width;
};

/// Change of intensity over half the width of `here`, next to two others or, at an end of the line,
/// to one of them and to itself.
double half_change(const LinePart& before, const LinePart& here, const LinePart& after) {
    const double first = &before == &here ? 0 : 0.5 * (before.width + here.width);
    const double second = &after == &here ? 0 : 0.5 * (here.width + after.width);
    return (after.mean - before.mean) * 0.5 * here.width / (first + second);
}

} // namespace

std::vector<BinPlane> reconstruct(const DirectionMesh& mesh, const ExitBins& exits,
                                  std::span<const Rgb> means) {
    constexpr double kSteepest = 0.999; // at 1 rounding would decide whether a corner scatters
    std::vector<LinePart> parts;        // solid angle is the width in a row, and in a column
    for (size_t bin = 0; bin < mesh.bins(); ++bin)
        parts.push_back(
            {(double(means[bin].r) + means[bin].g + means[bin].b) / 3, exits.solid_angle(bin)});
    std::vector<BinPlane> planes;
    planes.reserve(mesh.bins());
    const int columns = mesh.columns(), rows = mesh.rows();
    for (int column = 0; column < columns; ++column)
        for (int row = 0; row < rows; ++row) {
            const auto at = [&](int i, int j) -> const LinePart& {
                return parts[std::clamp(i, 0, columns - 1) * rows + std::clamp(j, 0, rows - 1)];
            };
            const LinePart& here = at(column, row);
            const double xi = half_change(at(column - 1, row), here, at(column + 1, row));
            const double eta = half_change(at(column, row - 1), here, at(column, row + 1));
            const double steepest = std::abs(xi) + std::abs(eta);
            const double scale = here.mean > 0 ? 1 / std::max(here.mean, steepest / kSteepest) : 0;
            planes.push_back({means[planes.size()], static_cast<float>(xi * scale),
                              static_cast<float>(eta * scale)});
        }
    return planes;
}

} // namespace rapport
