#pragma once

#include "materials/table/bsdf_table.h"
#include "materials/table/fast_chart.h"
#include "renderer/core/stop_signal.h"

#include <array>
#include <optional>

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
    /// Of a table whose grid is whole on both sides. Bands become linear RGB. Throws Stopped when
    /// told to stop, before one of the nodes.
    explicit PackedTable(const BsdfTable& table, const StopSignal& stopped = {});

    // The members of TableBsdf, of directions off the horizon.

    struct Value {
        Rgb intensity; ///< [1/sr]
        float pdf;
    };
    Value eval_and_pdf(const glm::vec3& eye, const glm::vec3& light) const;
    struct Sample {
        glm::vec3 light;
        Rgb weight;
        float pdf;
    };
    /// `choice` picks node and side, `u` the place: neighbours stay neighbours but for a half-turn
    /// within their bin, for samples that are spread evenly.
    std::optional<Sample> sample(const glm::vec3& eye, float choice, const glm::vec2& u) const;
    struct Shares {
        Rgb unscattered, scattered; ///< of the light from `eye`
    };
    Shares shares(const glm::vec3& eye) const;

  private:
    /// The grid along one angle of incidence.
    struct Axis {
        struct Interval {
            float start, per_length; ///< 1 over the length, or 0 of an axis of one value
            float end;               ///< infinite at the end of the axis
        };
        std::vector<Interval> intervals;
        /// The interval that each of many equal steps begins in, or one that is not far before.
        std::vector<uint32_t> guide;
        float steps; ///< of the guide, per unit

        explicit Axis(const std::vector<double>& axis);
        size_t interval(uint32_t step, float x) const;
    };

    /// What is known of an eye before the light is: the four nodes about it with their bilinear
    /// weights in (θ, φ), and the chart of the exits. φ goes round the circle, and beyond the first
    /// and last θ all stays constant.
    struct Eye {
        size_t first, second; ///< nodes at φ before and after, at θ before; θ after follows each
        Float4 weight;        ///< of first, first + 1, second, second + 1; their sum is 1
        FastChart chart;

        size_t node(size_t k) const { return (k < 2 ? first : second) + k % 2; }
    };
    struct EyeAndLight {
        Eye eye;
        FastChart::Point light;
    };
    EyeAndLight prepare(const glm::vec3& eye, const glm::vec3& light) const;
    Float4 albedo_parts(const Eye& eye) const;
    float mean_albedo(const Eye& eye) const;
    /// The interpolant [1/sr]; the fourth lane is not used.
    Float4 intensity(const Eye& eye, size_t block, const FastMesh::Place& place,
                     float density) const;

    struct Bin {
        uint16_t root[3];
        int8_t slope_xi, slope_eta;
    };
    void add_node(const BsdfTable& table, size_t side, size_t theta, size_t phi,
                  const std::vector<Rgb>& band_rgb);
    const Bin* nodes_of_bin(size_t block, size_t bin) const {
        return &bins_[(block * block_bins_ + bin) * nodes_];
    }

    DirectionMesh exits_;
    FastMesh mesh_;
    Axis theta_, phi_;
    Float4 starts_, steps_, last_; ///< of the guides of both
    float least_cosine_;           ///< of the last θ
    std::array<ConeAxis, 2> exit_axis_;
    /// Nodes are those of the whole grid, [side][φ][θ], with those at θ = 0 repeated for each φ.
    /// One more is kept at the end of all, since look-ups read two at a time.
    size_t thetas_, phis_, side_nodes_, nodes_, rows_, block_bins_;
    std::vector<Bin> bins_;                      ///< [block][bin][node]
    std::vector<float> scale_;                   ///< [node]: of the squares of the roots
    std::vector<float> reflected_, transmitted_; ///< [node]: mean albedos
    struct NodeShares {
        Float4 unscattered, scattered; ///< the fourth is not used
    };
    std::vector<NodeShares> shares_; ///< [node]
    /// [node][block]: the share of each column in its block, then of each row in its column,
    /// summed up to 1 (or 0 throughout), in whole cache lines.
    size_t column_lines_, row_lines_, cumulative_lines_;
    std::vector<Line> cumulative_;
};

} // namespace rapport
