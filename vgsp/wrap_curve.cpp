#include "vgsp/wrap_curve.h"

#include "renderer/core/math.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace rapport {
namespace {

/// The sign change of `f` from negative to not negative in [low, high], to the last bit.
template <class Function> double crossing(double low, double high, Function f) {
    for (int step = 0; step < 100; ++step) {
        const double middle = 0.5 * (low + high);
        (f(middle) < 0 ? low : high) = middle;
    }
    return high;
}

/// Cubic with given values and derivatives at 0 and `h`, evaluated at x.
double hermite(double x, double h, double f0, double f1, double d0, double d1) {
    const double t = x / h, u = 1 - t;
    return f0 * u * u * (1 + 2 * t) + f1 * t * t * (3 - 2 * t) + h * t * u * (d0 * u - d1 * t);
}

} // namespace

WrapCurve::WrapCurve(SectionOutline crossed, double own_half_height)
    : a_(crossed.half_width), b_(crossed.half_height), c_(own_half_height) {}

glm::dvec2 WrapCurve::point(double angle) const {
    const double s = std::sin(angle), c = std::cos(angle);
    const double ellipse = std::hypot(a_ * s, b_ * c);
    const double support = ellipse + c_;
    const double slope = (a_ - b_) * (a_ + b_) * s * c / ellipse;
    return {support * s + slope * c, support * c - slope * s};
}

double WrapCurve::curvature_radius(double angle) const {
    const double ellipse = std::hypot(a_ * std::sin(angle), b_ * std::cos(angle));
    return square(a_ * b_) / (ellipse * ellipse * ellipse) + c_;
}

WrapPassage::WrapPassage(const WrapCurve& from, const WrapCurve& to, double rise)
    : from_(from), to_(to), rise_(rise) {}

glm::dvec2 WrapPassage::mean_point(double angle) const {
    return 0.5 * (from_.point(angle) + to_.point(angle));
}

/// The angle at which the mean curve comes down to M's height.
double WrapPassage::shoulder() const {
    return crossing(0, kPi / 2, [&](double angle) { return rise_ / 2 - mean_point(angle).y; });
}

double WrapPassage::smallest_spacing() const {
    // There is a tangent through M as long as M lies outside the curve.
    return 2 * mean_point(shoulder()).x;
}

double WrapPassage::tangent_angle(double spacing) const {
    // M's height over the tangent at φ, negative at the crest and not negative at the angle where
    // the curve has come down to M's height, changes sign once between the two: the tangents that
    // leave M on their outer side form one interval, because the curve is convex.
    const glm::dvec2 m(spacing / 2, rise_ / 2);
    return crossing(0, shoulder(), [&](double angle) {
        const glm::dvec2 normal(std::sin(angle), std::cos(angle));
        return dot(normal, m - mean_point(angle));
    });
}

WrapArc::WrapArc(const WrapCurve& curve, double end_angle) {
    constexpr int kIntervals = 256;
    // Gauss–Legendre, three points.
    constexpr std::array<double, 3> kNodes{-0.7745966692414834, 0, 0.7745966692414834};
    constexpr std::array<double, 3> kWeights{5.0 / 18, 8.0 / 18, 5.0 / 18};

    const double step = end_angle / kIntervals;
    knots_.push_back({0, 0, 0, 1 / curve.curvature_radius(0)});
    for (int k = 1; k <= kIntervals; ++k) {
        Knot knot = knots_.back();
        for (size_t i = 0; i < kNodes.size(); ++i) {
            const double angle = (k - 0.5 + 0.5 * kNodes[i]) * step;
            const double length = curve.curvature_radius(angle) * kWeights[i] * step;
            knot.length += length;
            knot.integral += angle * length;
        }
        knot.angle = k * step;
        knot.curvature = 1 / curve.curvature_radius(knot.angle);
        knots_.push_back(knot);
    }
}

const WrapArc::Knot* WrapArc::interval(double sigma) const {
    const auto above = std::upper_bound(knots_.begin() + 1, knots_.end() - 1, sigma,
                                        [](double s, const Knot& k) { return s < k.length; });
    return &*above - 1;
}

double WrapArc::angle(double sigma) const {
    const Knot* k = interval(sigma);
    const double h = k[1].length - k[0].length;
    if (!(h > 0))
        return k[0].angle;
    return hermite(sigma - k[0].length, h, k[0].angle, k[1].angle, k[0].curvature, k[1].curvature);
}

double WrapArc::angle_integral(double sigma) const {
    const Knot* k = interval(sigma);
    const double h = k[1].length - k[0].length;
    if (!(h > 0))
        return k[0].integral;
    return hermite(sigma - k[0].length, h, k[0].integral, k[1].integral, k[0].angle, k[1].angle);
}

} // namespace rapport
