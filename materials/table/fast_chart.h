#pragma once

#include "materials/table/direction_mesh.h"
#include "materials/table/fast_angles.h"

namespace rapport {

// ExitChart and DirectionMesh for looking up, in single precision: u in the first of four lanes, v
// in the second. The two others mean nothing.

/// As ExitChart; angles by polynomials within 2e-6.
class FastChart {
  public:
    /// About an eye at y and at `quarter_turns` round the warp.
    FastChart(float y, float quarter_turns) {
        constexpr float kFarthest = ExitChart::kFarthest;
        const Float4 mirrored = -Float4{y, quarter_turns, y, quarter_turns};
        origin_ = clamp4(mirrored, -kFarthest, kFarthest);
        const Float4 length = 1 + Float4{1, 1, -1, -1} * origin_;
        below_ = 1 / length;
        above_ = __builtin_shufflevector(below_, below_, 2, 3, 2, 3);
    }

    struct Point {
        Float4 uv;
        float density; ///< area of (u, v) per solid angle [1/sr]
    };
    /// Of a unit vector, on its own hemisphere; beyond ±1 by rounding.
    Point point(float y, float quarter_turns) const {
        const Float4 offset = Float4{y, quarter_turns, 0, 0} - origin_;
        const Float4 inverse = offset < 0 ? below_ : above_;
        return {offset * inverse, static_cast<float>(2 / kPi) * inverse[0] * inverse[1]};
    }
    float density(Float4 uv) const {
        const Float4 inverse = uv < 0 ? below_ : above_;
        return static_cast<float>(2 / kPi) * inverse[0] * inverse[1];
    }

    /// The unit vector at (u, v), on the hemisphere of +z.
    glm::vec3 direction(Float4 uv) const {
        const Float4 moved = origin_ + uv * (1 + (uv < 0 ? origin_ : -origin_));
        const float y = moved[0], turn = moved[1];
        const Float4 sines = fast_sine(Float4{turn, 1 - std::abs(turn)});
        const float across = sqrt4(max4(four((1 - y) * (1 + y)), Float4{}))[0];
        return {across * sines[0], y, across * sines[1]};
    }

  private:
    Float4 origin_, below_, above_; ///< 1 over the lengths of the sides
};

/// As DirectionMesh.
class FastMesh {
  public:
    explicit FastMesh(const DirectionMesh& mesh)
        : rows_(mesh.rows()), middle_{mesh.columns() / 2, mesh.rows() / 2} {
        int lane = 0;
        for (const DirectionMesh::Axis* axis : {&mesh.u_axis(), &mesh.v_axis()}) {
            half_finest_[lane] = axis->half_finest;
            growth_[lane] = axis->growth;
            steps_[lane] = axis->steps;
            last_[lane++] = axis->middle - 0.5f;
            std::vector<Cell>& cells = lane == 1 ? column_cells_ : row_cells_;
            for (size_t i = 0; i + 1 < axis->edges.size(); ++i) {
                const double width = axis->edges[i + 1] - axis->edges[i];
                cells.push_back({static_cast<float>(axis->edges[i]), static_cast<float>(2 / width),
                                 static_cast<float>(width)});
            }
        }
    }

    struct Place {
        size_t bin;
        Float4 across; ///< ξ and η, from −1 to 1
    };
    Place place(Float4 uv) const {
        const Float4 root = sqrt4(half_finest_ * half_finest_ + growth_ * abs4(uv));
        const Float4 step = min4((root - half_finest_) * steps_, last_);
        const Int4 below = uv < 0; // all bits: ~out is −1 − out
        const Int4 cell = middle_ + (__builtin_convertvector(step, Int4) ^ below);
        const auto column = static_cast<uint32_t>(cell[0]), row = static_cast<uint32_t>(cell[1]);
        const Float4 cells = load_pairs(&column_cells_[column].low, &row_cells_[row].low);
        const Float4 low = __builtin_shufflevector(cells, cells, 0, 2, 0, 2);
        const Float4 per_half_width = __builtin_shufflevector(cells, cells, 1, 3, 1, 3);
        const Float4 across = (uv - low) * per_half_width - 1;
        return {size_t{column} * rows_ + row, clamp4(across, -1, 1)};
    }
    /// The point that lies `share`, ξ and η from 0 to 1, of the way across a cell.
    Float4 point(size_t column, size_t row, Float4 share) const {
        const Cell &u = column_cells_[column], &v = row_cells_[row];
        return Float4{u.low, v.low} + share * Float4{u.width, v.width};
    }

  private:
    struct Cell {
        float low, per_half_width, width;
    };
    size_t rows_;
    Int4 middle_;
    Float4 half_finest_{}, growth_{}, steps_{}, last_{};
    std::vector<Cell> column_cells_, row_cells_;
};

} // namespace rapport
