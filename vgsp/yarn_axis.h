#pragma once

#include "vgsp/wrap_curve.h"

#include <limits>
#include <memory>
#include <span>
#include <vector>

namespace rapport {

/// The axis of a yarn that passes over and under the yarns it crosses (the paper, section 3;
/// F. T. Peirce 1937, "The geometry of cloth structure", for crimp in both systems): the shortest
/// way that passes each crossed section on its side, which is arcs of the wrap curves joined by
/// the lines that touch both. It lies in a plane: `along` the yarn, and `height` over the cloth's
/// middle. Crossing k lies at along = (k + ½)·spacing, and everything repeats.
class YarnAxis {
  public:
    /// A yarn that is crossed. The axis does not touch one that lies clear of the way between its
    /// neighbours.
    struct Crossing {
        bool above;                          ///< this yarn passes over it
        double centre;                       ///< height of its centre [µm]
        std::shared_ptr<const WrapArc> wrap; ///< about its section
    };
    /// Lengths in µm. Throws std::invalid_argument if the yarn interlaces where `spacing` is
    /// smaller than WrapPassage::smallest_spacing().
    YarnAxis(std::span<const Crossing> crossings, double spacing);

    double period() const { return period_; } ///< of one repeat, straight [µm]
    double length() const { return length_; } ///< of one repeat, along the axis [µm]
    double turn() const { return turn_; }     ///< through which it turns in one repeat [rad]
    /// The smallest radius of curvature [µm]; infinite for a straight axis.
    double smallest_curvature_radius() const { return smallest_curvature_radius_; }
    double highest() const { return highest_; } ///< [µm]
    double lowest() const { return lowest_; }   ///< [µm]
    /// The slope over each crossing's middle [rad].
    const std::vector<double>& crossing_slopes() const { return crossing_slopes_; }

    struct Point {
        double along, height; ///< [µm]
        double slope;         ///< angle of the tangent over the plane of the cloth [rad]
    };
    /// At arc length `s`, any real number, from along = 0.
    Point at(double s) const;
    /// The mean of the slope over arc lengths s ± window/2; the slope itself for window 0.
    double mean_slope(double s, double window) const;

  private:
    struct Piece {
        double start;          ///< arc length from the first piece
        double slope_integral; ///< ∫ slope ds from there to `start`
        glm::dvec2 origin;     ///< arcs: centre of the crossed section; lines: first point
        const WrapArc* wrap;   ///< of an arc; none of a line
        double side;           ///< arcs: +1 over, −1 under
        double first;          ///< arcs: arc length from the crest at `start`; lines: slope
    };
    /// A crossing that the axis touches, and the line that leaves it.
    struct Touched {
        size_t crossing, next;
        double slope_in, slope_out;
    };
    static std::vector<Touched> touched(std::span<const Crossing> crossings, double spacing);
    void append_arc(const Crossing& crossing, double along, double slope_in, double slope_out);
    void append_line(glm::dvec2 from, glm::dvec2 to, double slope);
    double slope_integral_in(const Piece& piece, double t) const;
    Point from_first_piece(double s) const;
    const Piece& piece_at(double s) const;
    double slope_integral(double s) const;

    std::vector<std::shared_ptr<const WrapArc>> wraps_; ///< what pieces point to
    std::vector<Piece> pieces_;
    std::vector<double> crossing_slopes_;
    double period_, length_ = 0, turn_ = 0;
    double origin_ = 0;         ///< arc length from along = 0 to the first piece
    double slope_integral_ = 0; ///< ∫ slope ds over a repeat
    double smallest_curvature_radius_ = std::numeric_limits<double>::infinity();
    double highest_ = -std::numeric_limits<double>::infinity();
    double lowest_ = std::numeric_limits<double>::infinity();
};

} // namespace rapport
