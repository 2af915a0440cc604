#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

namespace rapport {

/// Piecewise-constant density on [0, 1), proportional to weights on cells of equal width. Where
/// all weights are zero the density is uniform. Cells of weight zero are never sampled.
class Distribution1D {
  public:
    /// Throws std::invalid_argument unless there is a weight and all are finite and not negative.
    explicit Distribution1D(std::span<const double> weights);
    explicit Distribution1D(std::span<const float> weights);

    struct Sample {
        double x;   ///< [0, 1)
        double pdf; ///< density per unit length at x, > 0
    };
    Sample sample(double u) const;          ///< `u` in [0, 1)
    double pdf(double x) const;             ///< at `x` in [0, 1)
    double total() const { return total_; } ///< Σ weights

  private:
    std::vector<double> cdf_; ///< at the cells' edges, from 0 to exactly 1
    /// The cell that each of as many equal steps of `u` begins in: the right one is a step further
    /// in the mean.
    std::vector<uint32_t> first_cell_;
    double total_ = 0;
};

/// The same on [0, 1)², for weights in rows: y picks the row, then x the cell within it.
class Distribution2D {
  public:
    /// `weights` has width·height elements, row 0 (y = 0) first.
    Distribution2D(std::span<const float> weights, int width, int height);

    struct Sample {
        glm::dvec2 position; ///< [0, 1)²
        double pdf;          ///< density per unit area, > 0
    };
    Sample sample(const glm::dvec2& u) const; ///< `u` in [0, 1)²
    double pdf(const glm::dvec2& position) const;
    double total() const { return rows_.total(); } ///< Σ weights

  private:
    std::vector<Distribution1D> cells_of_row_;
    Distribution1D rows_;
};

} // namespace rapport
