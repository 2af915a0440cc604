#pragma once

#include "materials/table/bsdf_table.h"
#include "materials/table/float4.h"

#include <array>

namespace rapport {

/// A full table laid out for looking up.
///
/// What is kept of a bin is its flux per area of the chart, in which the blend of the four nodes
/// about a direction of incidence is one bin at one place: the square root of each channel in 16
/// bits of the node's largest, and the slopes of its plane in 8 bits, 8 bytes in all. Bins of the
/// same number of all nodes of a side lie together, so that a look-up reads two or three cache
/// lines. Everything else (albedo, the distributions sampled) is computed from what is kept, so
/// that rounding makes no sample heavier than another.
class PackedTable {
  public:
    /// Of a table whose grid is whole on both sides. Bands become linear RGB.
    explicit PackedTable(const BsdfTable& table);

    /// The nodes about a direction of incidence and their bilinear weights in (θ, φ), which sum to
    /// 1; φ goes round the circle, and beyond the first and last θ all stays constant.
    struct Blend {
        uint32_t side;
        std::array<uint32_t, 4> node; ///< of that side
        std::array<float, 4> weight;
    };
    Blend blend(const glm::vec3& eye) const;

    Rgb albedo(const Blend& blend) const { return blended(blend, albedo_); }
    Rgb unscattered(const Blend& blend) const { return blended(blend, unscattered_); }
    /// The chart of the exits. Beyond the last θ it stays where it is: to follow the mirror
    /// direction down to the horizon would heap up the light before it.
    ExitChart<float> chart(const glm::vec3& eye) const;
    /// The interpolant [1/sr]; `chart` is the eye's.
    Rgb intensity(const Blend& blend, const ExitChart<float>& chart, const glm::vec3& light) const;

    struct Exit {
        bool transmitted;
        ChartPoint<float> point;
    };
    /// Draws an exit in proportion to the mean of the channels. `choice` picks node and side, `u`
    /// the place: neighbours stay neighbours, for samples that are spread evenly. The albedo must
    /// not be 0.
    Exit sample(const Blend& blend, float choice, const glm::vec2& u) const;

  private:
    /// The grid along one angle of incidence.
    struct Axis {
        std::vector<float> values, per_step; ///< per_step: 1 over the lengths of the intervals
        /// The interval that each of as many equal steps as there are intervals begins in: on an
        /// even axis the one that is looked for, else near it.
        std::vector<uint32_t> guide;
        float steps; ///< per unit

        explicit Axis(const std::vector<double>& axis);
        struct Place {
            size_t interval;
            float share; ///< of the way along it, [0, 1]
        };
        Place place(float x) const;
    };
    struct Bin {
        uint16_t root[3];
        int8_t slope_xi, slope_eta;
    };
    void add_node(const BsdfTable& table, size_t side, size_t node,
                  const std::vector<Rgb>& band_rgb);
    Rgb blended(const Blend& blend, const std::vector<Float4>& values) const;

    DirectionMesh mesh_;
    Axis theta_, phi_;
    float least_cosine_; ///< of the last θ
    size_t phis_, nodes_; ///< nodes of the whole grid of a side, those at θ = 0 repeated for each φ
    std::vector<Bin> bins_;                    ///< [side][block][bin][node]
    std::vector<float> scale_;                 ///< [side][node]: of the squares of the roots
    std::vector<Float4> albedo_, unscattered_; ///< [side][node]; the fourth is not used
    std::vector<float> share_;                 ///< [side][node][block]: mean albedo of a block
    /// [side][node][block]: the share of each column in its block, then of each row in its column,
    /// summed up to 1 (or 0 throughout), in fours.
    size_t column_fours_, row_fours_, cumulative_size_;
    std::vector<Float4> cumulative_;
};

} // namespace rapport
