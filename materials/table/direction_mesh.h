#pragma once

#include "materials/table/exit_chart.h"

#include <vector>

namespace rapport {

/// A mesh of exits over the chart of a hemisphere (exit_chart.h): columns across u and rows across
/// v, so that it moves with the highlight. Its bins are rectangles that do not straddle u = 0,
/// where the highlight is; from there to the edge the widths of columns grow linearly, by |u| = k·t
/// + (1 − k)·t² over equal steps of t. Rows are equal. Bin numbers run along v within a column.
class DirectionMesh {
  public:
    static constexpr int kMost = 512; ///< columns, and rows
    /// An even number of columns from 2 to kMost, of rows from 1; std::invalid_argument for others.
    /// The default is the knee of tests/bench/charts/parameterisation.svg.
    explicit DirectionMesh(int columns = 24, int rows = 16);

    size_t bins() const { return static_cast<size_t>(columns()) * rows(); }
    int columns() const { return 2 * middle_; }
    int rows() const { return rows_; }
    const std::vector<double>& u_edges() const { return u_edges_; }
    const std::vector<double>& v_edges() const { return v_edges_; }

    struct Bounds {
        double u_low, u_high, v_low, v_high;
    };
    Bounds bounds(size_t bin) const;
    /// A place in a bin: ξ across u and η across v, from −1 to 1.
    struct Place {
        size_t bin;
        double xi, eta;
    };
    Place place(const ChartPoint& point) const {
        const double step =
            (std::sqrt(square(kFinest / 2) + (1 - kFinest) * std::abs(point.u)) - kFinest / 2) *
            (middle_ / (1 - kFinest));
        const int out = std::min(static_cast<int>(step), middle_ - 1);
        const auto column = static_cast<size_t>(middle_ + (point.u < 0 ? -1 - out : out));
        const double low = u_edges_[column], high = u_edges_[column + 1];
        const double down = 0.5 * (point.v + 1) * rows_;
        const int row = std::clamp(static_cast<int>(down), 0, rows_ - 1);
        return {column * rows_ + row,
                std::clamp((2 * point.u - low - high) / (high - low), -1.0, 1.0),
                std::clamp(2 * (down - row) - 1, -1.0, 1.0)};
    }
    ChartPoint point(const Place& place) const {
        const Bounds b = bounds(place.bin);
        return {std::lerp(b.u_low, b.u_high, 0.5 * (place.xi + 1)),
                std::lerp(b.v_low, b.v_high, 0.5 * (place.eta + 1))};
    }

    bool operator==(const DirectionMesh&) const = default;

    /// k: the width of the columns at the highlight over that of equal ones.
    static constexpr double kFinest = 0.15;

  private:
    int middle_; ///< columns to either side of the highlight
    int rows_;
    std::vector<double> u_edges_, v_edges_;
};

/// The bins of the exits of light from one direction. Refers to the mesh.
class ExitBins {
  public:
    ExitBins(const DirectionMesh& mesh, const glm::dvec3& towards_light,
             ConeAxis axis = ConeAxis::warp)
        : mesh_(mesh), chart_(towards_light, axis) {}

    const ExitChart& chart() const { return chart_; }

    /// The bin of the unit vector `w` on its own hemisphere.
    size_t bin(const glm::dvec3& w) const { return mesh_.place(chart_.point(w)).bin; }
    /// 4·bin + q, q the quarter of the bin that `w` lies in: each bin is cut in two at the middle
    /// of its u and of its v, so that its quarters have equal solid angles. It is the mesh twice as
    /// fine that keeps the edges of this one.
    size_t quarter(const glm::dvec3& w) const;
    double solid_angle(size_t bin) const; ///< [sr]
    /// The unit vector at (ξ, η) of a bin, on the hemisphere of +z.
    glm::dvec3 direction(size_t bin, double xi = 0, double eta = 0) const;

  private:
    const DirectionMesh& mesh_;
    ExitChart chart_;
};

} // namespace rapport
