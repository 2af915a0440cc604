#pragma once

#include "vgsp/wrap_curve.h"

#include <limits>
#include <span>
#include <vector>

namespace rapport {

/// The axis of a yarn that passes over and under the yarns it crosses (the paper, section 3;
/// F. T. Peirce 1937, "The geometry of cloth structure", for crimp in both systems): arcs of the
/// wrap curve about each crossed section where the yarn interlaces, joined by the lines that touch
/// both; straight where it floats. It lies in a plane: `along` the yarn, and `height` over the
/// cloth's middle. Crossing k lies at along = (k + ½)·spacing, and everything repeats.
///
/// At a crossing the axis is own_crimp/2 above or below the middle and the crossed one
/// crossed_crimp/2 on the other side: the sections touch if the two crimp heights (Peirce's h, peak
/// to peak) sum to the two yarns' heights. The crossed yarns may differ.
class YarnAxis {
  public:
    /// A yarn that is crossed.
    struct Crossing {
        bool above;            ///< this yarn passes over it
        const WrapCurve* wrap; ///< about its section
        double crimp;          ///< its own [µm]
    };
    /// Lengths in µm. Throws std::invalid_argument if the yarn interlaces where `spacing` is
    /// smaller than WrapPassage::smallest_spacing().
    YarnAxis(std::span<const Crossing> crossings, double spacing, double own_crimp);
    /// Over and under yarns that are all alike; `above[k]`: over crossing k.
    YarnAxis(std::span<const uint8_t> above, double spacing, const WrapCurve& wrap,
             double own_crimp, double crossed_crimp);

    double period() const { return period_; } ///< of one repeat, straight [µm]
    double length() const { return length_; } ///< of one repeat, along the axis [µm]
    double turn() const { return turn_; }     ///< through which it turns in one repeat [rad]
    /// The smallest radius of curvature [µm]; infinite for a straight axis.
    double smallest_curvature_radius() const { return smallest_curvature_radius_; }

    struct Point {
        double along, height; ///< [µm]
        double slope;         ///< angle of the tangent over the plane of the cloth [rad]
    };
    /// At arc length `s`, any real number, from half-way between crossings −1 and 0, which is at
    /// along = 0 where the two are alike.
    Point at(double s) const;
    /// The mean of the slope over arc lengths s ± window/2; the slope itself for window 0.
    double mean_slope(double s, double window) const;

  private:
    enum class Kind { leaving_crest, straight, approaching_crest };
    struct Piece {
        Kind kind;
        double start, length;  ///< arc length from crossing 0
        glm::dvec2 origin;     ///< arcs: centre of the crossed section; straight: first point
        double side;           ///< arcs: +1 over, −1 under
        double slope;          ///< straight
        double slope_integral; ///< ∫ slope ds from crossing 0 to the start
        size_t arc;            ///< arcs: which
    };
    struct Arc {
        WrapCurve curve;
        double end_angle;
        WrapArc arc;
    };
    size_t arc_to(const WrapCurve& curve, double end_angle);
    void append(Kind kind, double length, glm::dvec2 origin, double side, double slope,
                size_t arc = 0);
    const Piece& piece_at(double s) const;
    double slope_integral(double s) const;

    std::vector<Arc> arcs_; ///< those that differ
    std::vector<Piece> pieces_;
    double period_, length_ = 0, turn_ = 0;
    double first_crossing_ = 0; ///< arc length from half an interval before it to crossing 0
    double slope_integral_ = 0; ///< ∫ slope ds over a repeat
    double smallest_curvature_radius_ = std::numeric_limits<double>::infinity();
};

} // namespace rapport
