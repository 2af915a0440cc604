#include "vgsp/wrap_curve.h"

#include "renderer/core/math.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace rapport {
namespace {

constexpr int kIntervals = 1024; ///< of a wrap curve's quarter
constexpr double kStep = kPi / 2 / kIntervals;

/// The sign change of `f` from negative at `low` to not negative at `high`, to the last bits: by
/// false position, which halves the weight of an end that stays (the Illinois method), and in half
/// where that is slow.
template <class Function> double crossing(double low, double high, Function f) {
    double at_low = f(low), at_high = f(high);
    if (!(at_low < 0))
        return low;
    int kept = 0;
    for (int step = 0; step < 200; ++step) {
        const double middle = 0.5 * (low + high);
        if (!(low < middle && middle < high))
            break;
        double x = (low * at_high - high * at_low) / (at_high - at_low);
        if (step % 8 == 7 || !(x > low && x < high))
            x = middle;
        const double value = f(x);
        if (value == 0)
            return x;
        if (value < 0) {
            low = x, at_low = value;
            at_high *= kept < 0 ? 0.5 : 1;
            kept = -1;
        } else {
            high = x, at_high = value;
            at_low *= kept > 0 ? 0.5 : 1;
            kept = 1;
        }
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

double WrapCurve::support(double angle) const {
    return std::hypot(a_ * std::sin(angle), b_ * std::cos(angle)) + c_;
}

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

WrapPassage::WrapPassage(WrapSide from, WrapSide to, double rise)
    : from_(*from.curve), to_(*to.curve), crosses_(from.above != to.above),
      mirror_(from.above ? 1 : -1), rise_(mirror_ * rise) {}

// With M half-way between the centres, the line from above one section to below the other is a
// tangent through M to the curve of their mean points, whose support function is the mean of
// theirs: there is one as long as M lies outside that curve.

glm::dvec2 WrapPassage::mean_point(double angle) const {
    return 0.5 * (from_.point(angle) + to_.point(angle));
}

/// The angle of a tangent that leaves M on its outer side, of all of which there is one interval,
/// because the curve is convex: the crest's for an M that is as high; else of the curve at M's
/// height, of which M lies outwards.
double WrapPassage::outermost() const {
    if (rise_ / 2 >= mean_point(0).y)
        return 0;
    return crossing(0, kPi, [&](double angle) { return rise_ / 2 - mean_point(angle).y; });
}

double WrapPassage::smallest_spacing() const {
    if (!crosses_ || rise_ / 2 >= mean_point(0).y)
        return 0;
    // Below the middle of the curve the line would turn back before M passes through it.
    return 2 * mean_point(std::min(outermost(), kPi / 2)).x;
}

double WrapPassage::slope(double spacing) const {
    return mirror_ * (crosses_ ? slope_to_other_side(spacing) : slope_to_same_side(spacing));
}

double WrapPassage::slope_to_other_side(double spacing) const {
    const glm::dvec2 m(spacing / 2, rise_ / 2);
    const double outer = std::min(outermost(), kPi / 2);
    return -crossing(outer - kPi / 2, outer, [&](double angle) {
        const glm::dvec2 normal(std::sin(angle), std::cos(angle));
        return dot(normal, m) - 0.5 * (from_.support(angle) + to_.support(angle));
    });
}

/// Where both sections reach as far in the direction of the line's normal, the line is on both.
double WrapPassage::slope_to_same_side(double spacing) const {
    if (rise_ == 0 && from_.support(0) == to_.support(0))
        return 0;
    return -crossing(-kPi / 2, kPi / 2, [&](double angle) {
        const glm::dvec2 normal(std::sin(angle), std::cos(angle));
        return dot(normal, {spacing, rise_}) + to_.support(angle) - from_.support(angle);
    });
}

WrapArc::WrapArc(const WrapCurve& curve) : curve_(curve) {
    // Gauss–Legendre, three points.
    constexpr std::array<double, 3> kNodes{-0.7745966692414834, 0, 0.7745966692414834};
    constexpr std::array<double, 3> kWeights{5.0 / 18, 8.0 / 18, 5.0 / 18};

    knots_.reserve(kIntervals + 1);
    knots_.push_back({0, 0, curve.curvature_radius(0)});
    for (int k = 1; k <= kIntervals; ++k) {
        Knot knot = knots_.back();
        for (size_t i = 0; i < kNodes.size(); ++i) {
            const double angle = (k - 0.5 + 0.5 * kNodes[i]) * kStep;
            const double length = curve.curvature_radius(angle) * kWeights[i] * kStep;
            knot.length += length;
            knot.integral += angle * length;
        }
        knot.radius = curve.curvature_radius(k * kStep);
        knots_.push_back(knot);
    }
}

double WrapArc::length(double angle) const {
    const double size = std::abs(angle);
    const size_t k = std::min(size_t(size / kStep), knots_.size() - 2);
    const Knot &a = knots_[k], &b = knots_[k + 1];
    return std::copysign(hermite(size - k * kStep, kStep, a.length, b.length, a.radius, b.radius),
                         angle);
}

/// The number of the interval of knots that σ ≥ 0 lies in.
size_t WrapArc::interval(double sigma) const {
    const auto above = std::upper_bound(knots_.begin() + 1, knots_.end() - 1, sigma,
                                        [](double s, const Knot& k) { return s < k.length; });
    return size_t(above - knots_.begin()) - 1;
}

double WrapArc::angle(double sigma) const {
    const double size = std::abs(sigma);
    const size_t k = interval(size);
    const Knot &a = knots_[k], &b = knots_[k + 1];
    return std::copysign(hermite(size - a.length, b.length - a.length, k * kStep, (k + 1) * kStep,
                                 1 / a.radius, 1 / b.radius),
                         sigma);
}

double WrapArc::angle_integral(double sigma) const {
    const double size = std::abs(sigma);
    const size_t k = interval(size);
    const Knot &a = knots_[k], &b = knots_[k + 1];
    return hermite(size - a.length, b.length - a.length, a.integral, b.integral, k * kStep,
                   (k + 1) * kStep);
}

} // namespace rapport
