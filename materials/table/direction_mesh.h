#pragma once

#include "materials/table/exit_chart.h"

#include <vector>

namespace rapport {

/// A mesh of exits over the chart of a hemisphere (exit_chart.h): columns across u and rows across
/// v, so that it moves with the highlights. Its bins are rectangles that do not straddle u = 0 or
/// v = 0, where the highlights are; from there to the edge their widths grow linearly, by
/// |u| = k·t + (1 − k)·t² over equal steps of t. Bin numbers run along v within a column.
class DirectionMesh {
  public:
    static constexpr int kMost = 512; ///< columns, and rows
    /// Even numbers from 2 to kMost; std::invalid_argument for others. The default is the knee of
    /// tests/bench/charts/parameterisation.svg.
    explicit DirectionMesh(int columns = 24, int rows = 16);

    size_t bins() const { return static_cast<size_t>(columns()) * rows(); }
    int columns() const { return 2 * u_.middle; }
    int rows() const { return 2 * v_.middle; }
    const std::vector<double>& u_edges() const { return u_.edges; }
    const std::vector<double>& v_edges() const { return v_.edges; }

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
        const size_t column = u_.cell(point.u), row = v_.cell(point.v);
        return {column * rows() + row, u_.across(column, point.u), v_.across(row, point.v)};
    }
    ChartPoint point(const Place& place) const {
        return {u_.at(place.bin / rows(), place.xi), v_.at(place.bin % rows(), place.eta)};
    }

    bool operator==(const DirectionMesh&) const = default;

    /// How one coordinate is cut.
    struct Axis {
        int middle;                ///< cells to either side of 0
        float half_finest, growth; ///< k/2, k the finest width over that of equal cells; 1 − k
        float steps;               ///< middle over 1 − k
        std::vector<double> edges;

        Axis(int count, double finest);
        bool operator==(const Axis&) const = default;
        size_t cell(double x) const {
            const double half = half_finest;
            const double step = (std::sqrt(half * half + growth * std::abs(x)) - half) * steps;
            const int out = std::min(static_cast<int>(step), middle - 1);
            return static_cast<size_t>(middle + (x < 0 ? -1 - out : out));
        }
        /// From −1 to 1 across a cell, and back.
        double across(size_t cell, double x) const {
            const double low = edges[cell], high = edges[cell + 1];
            return std::clamp((2 * x - low - high) / (high - low), -1.0, 1.0);
        }
        double at(size_t cell, double across) const {
            return std::lerp(edges[cell], edges[cell + 1], 0.5 * (across + 1));
        }
    };
    const Axis& u_axis() const { return u_; }
    const Axis& v_axis() const { return v_; }

  private:
    Axis u_, v_;
};

/// The bins of the exits of light from one direction. Refers to the mesh.
class ExitBins {
  public:
    ExitBins(const DirectionMesh& mesh, const glm::dvec3& towards_light)
        : mesh_(mesh), chart_(towards_light) {}

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
