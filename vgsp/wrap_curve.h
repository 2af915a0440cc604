#pragma once

#include <glm/glm.hpp>
#include <vector>

namespace rapport {

/// A yarn's section as an upright ellipse, flattening included [µm].
struct SectionOutline {
    double half_width = 0;  ///< in the plane of the cloth
    double half_height = 0; ///< across it
};

/// The curve on which a yarn's axis wraps a crossed yarn: the parallel curve of the crossed
/// section at the distance of the yarn's own half height. For a circular section it is the circle
/// of the paper (section 3), radius = warp radius + weft radius.
///
/// Points are named by the angle φ ∈ [−π/2, π/2] of the curve's normal from the crest (straight up)
/// towards the yarn's direction; coordinates (along, up) [µm] are relative to the section's centre.
/// With the section's support function h(φ) = √(a²sin²φ + b²cos²φ) + c, the point is
/// h·(sin φ, cos φ) + h′·(cos φ, −sin φ) and the radius of curvature h + h″.
class WrapCurve {
  public:
    WrapCurve(SectionOutline crossed, double own_half_height);

    double support(double angle) const; ///< h [µm]
    glm::dvec2 point(double angle) const;
    double curvature_radius(double angle) const; ///< [µm]

  private:
    double a_, b_, c_; ///< crossed half width and half height, own half height
};

/// A yarn passes one crossed section, wrapping `curve`, over it or under it.
struct WrapSide {
    const WrapCurve* curve;
    bool above;
};

/// The way of a yarn from one crossed section to the next, whose centre is `rise` higher [µm]:
/// along the line that touches both wrap curves, each on its side.
class WrapPassage {
  public:
    WrapPassage(WrapSide from, WrapSide to, double rise);

    /// The smallest distance of the two sections along the yarn between which the axis can pass
    /// without turning back [µm]. From above circles of radius D to below them: √(4D² − rise²).
    double smallest_spacing() const;
    /// The slope of the line where they are `spacing` ≥ smallest_spacing() apart, in [−π/2, π/2].
    double slope(double spacing) const;

  private:
    double slope_to_same_side(double spacing) const;
    double slope_to_other_side(double spacing) const;
    glm::dvec2 mean_point(double angle) const;
    double outermost() const;

    WrapCurve from_, to_; ///< mirrored, where need be, so that the yarn comes from above
    bool crosses_;
    double mirror_, rise_;
};

/// A wrap curve by its arc length σ from the crest, of the sign of the angle. Exact for circles;
/// for ellipses interpolated with a relative error below 1e-8.
class WrapArc {
  public:
    explicit WrapArc(const WrapCurve& curve);

    const WrapCurve& curve() const { return curve_; }
    double length(double angle) const;         ///< σ at an angle
    double angle(double sigma) const;          ///< at σ
    double angle_integral(double sigma) const; ///< ∫₀^σ φ dσ

  private:
    struct Knot {
        double length, integral, radius;
    };
    size_t interval(double sigma) const;

    WrapCurve curve_;
    std::vector<Knot> knots_; ///< at equal steps of the angle from 0 to π/2
};

} // namespace rapport
