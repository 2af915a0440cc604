#pragma once

#include "renderer/core/math.h"

#include <array>
#include <cstddef>
#include <span>
#include <vector>

namespace rapport {

/// Up to four slices of a tabulated function and their weights, which sum to 1.
struct SliceBlend {
    std::array<size_t, 4> slice{};
    std::array<float, 4> weight{};
};

/// Bilinear interpolation over a rectangular grid of parameters, held constant beyond its ends:
/// slice number = outer index · inner.size() + inner index. Both axes ascend.
SliceBlend blend_slices(std::span<const float> outer, float at_outer, std::span<const float> inner,
                        float at_inner);

/// A place on a grid of rows × columns over the unit square, whose outermost nodes lie on its
/// edges.
struct GridCell {
    size_t row, column; ///< of the cell's corner next to (0, 0)
    float y, x;         ///< [0, 1] inside the cell
};
GridCell grid_cell(size_t rows, size_t columns, const glm::vec2& position);

/// The map of the unit square onto itself that makes uniform points into points of a given density,
/// and its inverse: a marginal in y, then a conditional in x (Dupuy & Jakob 2018, "An Adaptive
/// Parameterization for Efficient Material Acquisition and Rendering", section 4). The density is
/// bilinear between the nodes of a grid, and a weighted mean of slices, each normalised to 1;
/// both ways are exact for the blended density. A slice that is 0 throughout counts as uniform.
class MarginalWarp {
  public:
    MarginalWarp() = default;
    /// `values` holds whole slices of rows × columns ≥ 2 × 2, finite and ≥ 0.
    MarginalWarp(std::span<const float> values, size_t rows, size_t columns);

    struct Point {
        glm::vec2 position;
        float pdf; ///< at the end of higher density, the square that `sample` maps to
    };
    Point sample(const SliceBlend& blend, const glm::vec2& uniform) const;
    Point invert(const SliceBlend& blend, const glm::vec2& position) const;
    float pdf(const SliceBlend& blend, const glm::vec2& position) const;

  private:
    float blended(const std::vector<float>& of, size_t stride, const SliceBlend& blend,
                  size_t i) const {
        float sum = 0;
        for (size_t k = 0; k < blend.slice.size(); ++k)
            sum += blend.weight[k] * of[blend.slice[k] * stride + i];
        return sum;
    }
    float density(const SliceBlend& blend, size_t row, size_t column) const {
        return blended(density_, rows_ * columns_, blend, row * columns_ + column);
    }
    float row_total(const SliceBlend& blend, size_t row) const {
        return blended(along_row_, rows_ * columns_, blend, (row + 1) * columns_ - 1);
    }
    /// ∫ of the density from the start of the row at `cell.y` to the node `column`.
    float along_row(const SliceBlend& blend, const GridCell& cell, size_t column) const;

    size_t rows_ = 0, columns_ = 0;
    std::vector<float> density_;   ///< [slices, rows, columns]
    std::vector<float> along_row_; ///< ∫ of the density along its row, up to each node
    std::vector<float> of_rows_;   ///< [slices, rows], ∫ of the rows' totals up to each
};

} // namespace rapport
