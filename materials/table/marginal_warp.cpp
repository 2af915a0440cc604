#include "materials/table/marginal_warp.h"

#include <algorithm>
#include <cmath>

namespace rapport {
namespace {

/// A place on an axis: between the nodes `low` and `high`, `t` of the way.
struct AxisPlace {
    size_t low, high;
    float t;
};

AxisPlace place_on(std::span<const float> axis, float at) {
    const auto above = std::upper_bound(axis.begin(), axis.end(), at);
    if (above == axis.begin())
        return {0, 0, 0};
    if (above == axis.end())
        return {axis.size() - 1, axis.size() - 1, 0};
    const auto high = static_cast<size_t>(above - axis.begin());
    return {high - 1, high, (at - axis[high - 1]) / (axis[high] - axis[high - 1])};
}

/// ∫₀ᵗ of the line from a (at 0) to b (at 1).
float line_integral(float a, float b, float t) { return t * (a + 0.5f * t * (b - a)); }

/// The t in [0, 1] at which `line_integral` is `integral`; of the quadratic's forms the one that
/// loses no digits, whichever end is higher.
float solve_line_integral(float a, float b, float integral) {
    const float root = a + safe_sqrt(a * a + 2 * integral * (b - a));
    return root > 0 ? std::clamp(2 * integral / root, 0.0f, 1.0f) : 0;
}

/// The last i in [0, size − 2] whose `cumulative(i)` ≤ value, for a function that ascends.
template <class F> size_t find_interval(size_t size, float value, const F& cumulative) {
    size_t low = 0, high = size - 1;
    while (high - low > 1) {
        const size_t middle = (low + high) / 2;
        (cumulative(middle) <= value ? low : high) = middle;
    }
    return low;
}

} // namespace

SliceBlend blend_slices(std::span<const float> outer, float at_outer, std::span<const float> inner,
                        float at_inner) {
    const AxisPlace o = place_on(outer, at_outer), i = place_on(inner, at_inner);
    const size_t n = inner.size();
    return {{o.low * n + i.low, o.low * n + i.high, o.high * n + i.low, o.high * n + i.high},
            {(1 - o.t) * (1 - i.t), (1 - o.t) * i.t, o.t * (1 - i.t), o.t * i.t}};
}

GridCell grid_cell(size_t rows, size_t columns, const glm::vec2& position) {
    const float y = std::clamp(position.y, 0.0f, 1.0f) * static_cast<float>(rows - 1);
    const float x = std::clamp(position.x, 0.0f, 1.0f) * static_cast<float>(columns - 1);
    const size_t row = std::min(static_cast<size_t>(y), rows - 2);
    const size_t column = std::min(static_cast<size_t>(x), columns - 2);
    return {row, column, y - static_cast<float>(row), x - static_cast<float>(column)};
}

MarginalWarp::MarginalWarp(std::span<const float> values, size_t rows, size_t columns)
    : rows_(rows), columns_(columns), density_(values.size()), along_row_(values.size()),
      of_rows_(values.size() / columns) {
    const double width = 1.0 / static_cast<double>(columns - 1);
    const double height = 1.0 / static_cast<double>(rows - 1);
    std::vector<double> totals(rows);
    for (size_t first = 0; first < values.size(); first += rows * columns) {
        const auto value = [&](size_t row, size_t column) -> double {
            return values[first + row * columns + column];
        };
        double total = 0;
        for (size_t row = 0; row < rows; ++row) {
            totals[row] = 0;
            for (size_t column = 1; column < columns; ++column)
                totals[row] += 0.5 * width * (value(row, column - 1) + value(row, column));
            if (row > 0)
                total += 0.5 * height * (totals[row - 1] + totals[row]);
        }
        double before = 0;
        for (size_t row = 0; row < rows; ++row) {
            const auto scaled = [&](size_t column) {
                return total > 0 ? value(row, column) / total : 1;
            };
            double along = 0;
            for (size_t column = 0; column < columns; ++column) {
                if (column > 0)
                    along += 0.5 * width * (scaled(column - 1) + scaled(column));
                density_[first + row * columns + column] = static_cast<float>(scaled(column));
                along_row_[first + row * columns + column] = static_cast<float>(along);
            }
            if (row > 0)
                before += 0.5 * height * (totals[row - 1] + along);
            totals[row] = along; // of the scaled density from here on
            of_rows_[first / columns + row] = static_cast<float>(before);
        }
    }
}

float MarginalWarp::along_row(const SliceBlend& blend, const GridCell& cell, size_t column) const {
    const size_t i = cell.row * columns_ + column;
    return std::lerp(blended(along_row_, rows_ * columns_, blend, i),
                     blended(along_row_, rows_ * columns_, blend, i + columns_), cell.y);
}

MarginalWarp::Point MarginalWarp::sample(const SliceBlend& blend, const glm::vec2& uniform) const {
    const auto of_rows = [&](size_t row) { return blended(of_rows_, rows_, blend, row); };
    GridCell cell{};
    cell.row = find_interval(rows_, uniform.y, of_rows);
    const auto rows_less_one = static_cast<float>(rows_ - 1);
    const float low = row_total(blend, cell.row), high = row_total(blend, cell.row + 1);
    cell.y = solve_line_integral(low, high, (uniform.y - of_rows(cell.row)) * rows_less_one);

    const auto along = [&](size_t column) { return along_row(blend, cell, column); };
    const float target = uniform.x * std::lerp(low, high, cell.y);
    cell.column = find_interval(columns_, target, along);
    const auto columns_less_one = static_cast<float>(columns_ - 1);
    const float left = std::lerp(density(blend, cell.row, cell.column),
                                 density(blend, cell.row + 1, cell.column), cell.y);
    const float right = std::lerp(density(blend, cell.row, cell.column + 1),
                                  density(blend, cell.row + 1, cell.column + 1), cell.y);
    cell.x = solve_line_integral(left, right, (target - along(cell.column)) * columns_less_one);
    return {{(static_cast<float>(cell.column) + cell.x) / columns_less_one,
             (static_cast<float>(cell.row) + cell.y) / rows_less_one},
            std::lerp(left, right, cell.x)};
}

MarginalWarp::Point MarginalWarp::invert(const SliceBlend& blend, const glm::vec2& position) const {
    const GridCell cell = grid_cell(rows_, columns_, position);
    const float left = std::lerp(density(blend, cell.row, cell.column),
                                 density(blend, cell.row + 1, cell.column), cell.y);
    const float right = std::lerp(density(blend, cell.row, cell.column + 1),
                                  density(blend, cell.row + 1, cell.column + 1), cell.y);
    const float low = row_total(blend, cell.row), high = row_total(blend, cell.row + 1);
    const float along = along_row(blend, cell, cell.column) +
                        line_integral(left, right, cell.x) / static_cast<float>(columns_ - 1);
    const float of_rows = blended(of_rows_, rows_, blend, cell.row) +
                          line_integral(low, high, cell.y) / static_cast<float>(rows_ - 1);
    const float total = std::lerp(low, high, cell.y);
    return {{total > 0 ? std::min(along / total, 1.0f) : cell.x, std::min(of_rows, 1.0f)},
            std::lerp(left, right, cell.x)};
}

float MarginalWarp::pdf(const SliceBlend& blend, const glm::vec2& position) const {
    const GridCell cell = grid_cell(rows_, columns_, position);
    return std::lerp(std::lerp(density(blend, cell.row, cell.column),
                               density(blend, cell.row, cell.column + 1), cell.x),
                     std::lerp(density(blend, cell.row + 1, cell.column),
                               density(blend, cell.row + 1, cell.column + 1), cell.x),
                     cell.y);
}

} // namespace rapport
