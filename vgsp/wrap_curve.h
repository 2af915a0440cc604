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
/// Points are named by the angle φ ∈ [0, π/2] of the curve's normal from the crest (straight up)
/// towards the yarn's direction; coordinates (along, up) [µm] are relative to the section's centre.
/// With the section's support function h(φ) = √(a²sin²φ + b²cos²φ) + c, the point is
/// h·(sin φ, cos φ) + h′·(cos φ, −sin φ) and the radius of curvature h + h″.
class WrapCurve {
  public:
    WrapCurve(SectionOutline crossed, double own_half_height);

    glm::dvec2 point(double angle) const;
    double curvature_radius(double angle) const; ///< [µm]
    bool operator==(const WrapCurve&) const = default;

  private:
    double a_, b_, c_; ///< crossed half width and half height, own half height
};

/// The way of a yarn from above one crossed section to below the next, wrapping the curves `from`
/// and `to` of the two, the next being `rise` = half of both crossed crimps higher [µm, 0 … both
/// crests]. With M half-way between their centres, the line that touches both is the tangent
/// through M to the curve of their mean points, whose support function is the mean of theirs.
class WrapPassage {
  public:
    WrapPassage(const WrapCurve& from, const WrapCurve& to, double rise);

    /// The smallest distance of the two sections between which the axis can pass [µm]. For circles
    /// of radius D: √(4D² − rise²).
    double smallest_spacing() const;
    /// The angle at which the axis leaves the one curve along the line that touches the other, from
    /// the other side, `spacing` ≥ smallest_spacing() away.
    double tangent_angle(double spacing) const;

  private:
    glm::dvec2 mean_point(double angle) const;
    double shoulder() const;

    WrapCurve from_, to_;
    double rise_;
};

/// The part of a wrap curve from its crest to an angle, by arc length σ ∈ [0, length()].
/// Exact for circles; for ellipses interpolated with a relative error below 1e-8.
class WrapArc {
  public:
    WrapArc(const WrapCurve& curve, double end_angle);

    double length() const { return knots_.back().length; }
    double angle(double sigma) const;
    double angle_integral(double sigma) const; ///< ∫₀^σ φ dσ

  private:
    struct Knot {
        double length, angle, integral, curvature;
    };
    std::vector<Knot> knots_;
    const Knot* interval(double sigma) const;
};

} // namespace rapport
