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

    /// The smallest distance of two crossed sections, one `crossed_crimp` higher than the other
    /// [µm, 0 … 2·(height of the crest)], between which the axis can pass from above the one to
    /// below the other. For a circle of radius D: √(4D² − crossed_crimp²).
    double smallest_spacing(double crossed_crimp) const;

    /// The angle at which the axis leaves the curve along the line that also touches the curve of
    /// the next section, `spacing` ≥ smallest_spacing(crossed_crimp) away, from the other side.
    double tangent_angle(double spacing, double crossed_crimp) const;

  private:
    double a_, b_, c_; ///< crossed half width and half height, own half height
    double crest_shoulder(double height) const;
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
