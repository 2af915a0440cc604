#pragma once

#include "materials/table/direction_mesh.h"
#include "materials/table/fast_angles.h"

namespace rapport {

// ExitChart and DirectionMesh for looking up, in single precision: u in the first of four lanes, v
// in the second. The two others mean nothing.

/// As ExitChart.
class FastChart {
  public:
    FastChart(Float4 eye, ConeAxis axis)
        : about_weft_(axis == ConeAxis::weft),
          ridge_(clamp4(four(-along(eye)), -kFarthest, kFarthest)[0]) {}

    /// Of a vector (x, y, z, …) the coordinates along the yarns and across them.
    float along(Float4 w) const { return about_weft_ ? w[0] : w[1]; }
    float across(Float4 w) const { return about_weft_ ? w[1] : w[0]; }

    struct Point {
        Float4 uv;
        float density; ///< area of (u, v) per solid angle [1/sr]
    };
    /// Of a unit vector and its quarter turns round the yarns, on its own hemisphere; beyond ±1 by
    /// rounding.
    Point point(Float4 w, float quarter_turns) const {
        const float beside = along(w) - ridge_, inverse = 1 / length(beside);
        return {Float4{beside * inverse, quarter_turns, 0, 0}, kDensity * inverse};
    }
    float density(Float4 uv) const { return kDensity / length(uv[0]); }

    /// The unit vector at (u, v), on the hemisphere of +z.
    glm::vec3 direction(Float4 uv) const {
        const float along = ridge_ + uv[0] * length(uv[0]);
        const Float4 sines = fast_sine(Float4{uv[1], 1 - std::abs(uv[1])});
        const float radius = sqrt4(max4(four((1 - along) * (1 + along)), Float4{}))[0];
        const float across = radius * sines[0], z = radius * sines[1];
        return about_weft_ ? glm::vec3(along, across, z) : glm::vec3(across, along, z);
    }

  private:
    static constexpr float kFarthest = ExitChart::kFarthest;
    static constexpr auto kDensity = static_cast<float>(2 / kPi);

    /// Of the side of the ridge that a number of this sign lies on; without a branch, which every
    /// second direction would take.
    float length(float beside) const { return 1 - std::copysign(1.0f, beside) * ridge_; }

    bool about_weft_;
    float ridge_;
};

/// As DirectionMesh.
class FastMesh {
  public:
    explicit FastMesh(const DirectionMesh& mesh)
        : middle_(mesh.columns() / 2), rows_(mesh.rows()),
          steps_(static_cast<float>(middle_ / (1 - DirectionMesh::kFinest))) {
        for (size_t i = 0; i + 1 < mesh.u_edges().size(); ++i) {
            const double low = mesh.u_edges()[i], width = mesh.u_edges()[i + 1] - low;
            columns_.push_back({static_cast<float>(low), static_cast<float>(2 / width),
                                static_cast<float>(width)});
        }
    }

    struct Place {
        size_t bin;
        Float4 across; ///< ξ and η, from −1 to 1
    };
    Place place(Float4 uv) const {
        constexpr auto kHalf = static_cast<float>(DirectionMesh::kFinest / 2);
        constexpr auto kGrowth = static_cast<float>(1 - DirectionMesh::kFinest);
        const float u = uv[0], root = sqrt4(four(kHalf * kHalf + kGrowth * std::abs(u)))[0];
        const int out = std::min(static_cast<int>((root - kHalf) * steps_), middle_ - 1);
        const int below = std::bit_cast<int32_t>(u) >> 31; // all bits: ~out is −1 − out
        const auto column = static_cast<uint32_t>(middle_ + (out ^ below));
        const float down = std::max(0.5f * static_cast<float>(rows_) * (uv[1] + 1), 0.0f);
        const int row = std::min(static_cast<int>(down), rows_ - 1);
        const Column& cut = columns_[column];
        const Float4 across = {(u - cut.low) * cut.per_half_width,
                               2 * (down - static_cast<float>(row)), 0, 0};
        return {size_t{column} * rows_ + row, clamp4(across - 1, -1, 1)};
    }
    /// The point that lies `share`, ξ and η from 0 to 1, of the way across a bin.
    Float4 point(size_t column, size_t row, Float4 share) const {
        const Column& cut = columns_[column];
        return Float4{cut.low + share[0] * cut.width,
                      (static_cast<float>(row) + share[1]) * 2 / static_cast<float>(rows_) - 1, 0,
                      0};
    }

  private:
    struct Column {
        float low, per_half_width, width;
    };
    int middle_, rows_;
    float steps_; ///< of the root, per column
    std::vector<Column> columns_;
};

} // namespace rapport
