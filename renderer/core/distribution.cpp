#include "renderer/core/distribution.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace rapport {
namespace {

/// The largest double below 1.
constexpr double kBelowOne = 1 - 0x1p-53;

size_t cell_at(double x, size_t count) {
    return std::min(static_cast<size_t>(std::max(x, 0.0) * static_cast<double>(count)), count - 1);
}

std::vector<Distribution1D> split_rows(std::span<const float> weights, int width, int height) {
    if (width < 1 || height < 1 ||
        weights.size() != static_cast<size_t>(width) * static_cast<size_t>(height))
        throw std::invalid_argument("distribution: weights do not fill width x height cells");
    std::vector<Distribution1D> rows;
    rows.reserve(height);
    for (int y = 0; y < height; ++y)
        rows.emplace_back(weights.subspan(static_cast<size_t>(y) * width, width));
    return rows;
}

std::vector<double> totals(const std::vector<Distribution1D>& rows) {
    std::vector<double> totals;
    for (const Distribution1D& row : rows)
        totals.push_back(row.total());
    return totals;
}

} // namespace

Distribution1D::Distribution1D(std::span<const float> weights)
    : Distribution1D(std::vector<double>(weights.begin(), weights.end())) {}

Distribution1D::Distribution1D(std::span<const double> weights) : cdf_(weights.size() + 1) {
    if (weights.empty())
        throw std::invalid_argument("distribution without weights");
    for (size_t i = 0; i < weights.size(); ++i) {
        if (!std::isfinite(weights[i]) || weights[i] < 0)
            throw std::invalid_argument("distribution weights must be finite and not negative");
        total_ += weights[i];
        cdf_[i + 1] = total_;
    }
    for (size_t i = 1; i < cdf_.size(); ++i)
        cdf_[i] = total_ > 0 ? cdf_[i] / total_
                             : static_cast<double>(i) / static_cast<double>(weights.size());
    uint32_t cell = 0;
    for (size_t i = 0; i < weights.size(); ++i) {
        while (cdf_[cell + 1] <= static_cast<double>(i) / static_cast<double>(weights.size()))
            ++cell;
        first_cell_.push_back(cell);
    }
}

Distribution1D::Sample Distribution1D::sample(double u) const {
    u = std::clamp(u, 0.0, kBelowOne);
    const double count = static_cast<double>(first_cell_.size());
    // The last edge at or below u: its cell is not empty, for the next edge lies above u.
    size_t cell = first_cell_[static_cast<size_t>(u * count)];
    while (cdf_[cell] > u) // the product was rounded up
        --cell;
    while (cdf_[cell + 1] <= u)
        ++cell;
    const double probability = cdf_[cell + 1] - cdf_[cell];
    const double x = (static_cast<double>(cell) + (u - cdf_[cell]) / probability) / count;
    // So far below the edge that `cell_at` cannot round it up.
    const double end = static_cast<double>(cell + 1) / count * (1 - 0x1p-50);
    return {std::min(x, end), probability * count};
}

double Distribution1D::pdf(double x) const {
    const size_t count = cdf_.size() - 1;
    const size_t cell = cell_at(x, count);
    return (cdf_[cell + 1] - cdf_[cell]) * static_cast<double>(count);
}

Distribution2D::Distribution2D(std::span<const float> weights, int width, int height)
    : cells_of_row_(split_rows(weights, width, height)), rows_(totals(cells_of_row_)) {}

Distribution2D::Sample Distribution2D::sample(const glm::dvec2& u) const {
    const Distribution1D::Sample y = rows_.sample(u.y);
    const Distribution1D::Sample x = cells_of_row_[cell_at(y.x, cells_of_row_.size())].sample(u.x);
    return {{x.x, y.x}, x.pdf * y.pdf};
}

double Distribution2D::pdf(const glm::dvec2& position) const {
    const Distribution1D& cells = cells_of_row_[cell_at(position.y, cells_of_row_.size())];
    return cells.pdf(position.x) * rows_.pdf(position.y);
}

} // namespace rapport
