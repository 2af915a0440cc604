#include "vgsp/yarn_axis.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

namespace rapport {
namespace {

constexpr double kRounding = 1e-9; ///< relative; what a spacing that just suffices may lack

bool interlaces(std::span<const uint8_t> above) {
    return std::adjacent_find(above.begin(), above.end(), std::not_equal_to<>()) != above.end();
}

double contact_angle(std::span<const uint8_t> above, double spacing, const WrapCurve& wrap,
                     double crossed_crimp) {
    if (!interlaces(above))
        return 0;
    if (!(spacing >= wrap.smallest_spacing(crossed_crimp) * (1 - kRounding)))
        throw std::invalid_argument("the crossed yarns are too close for a yarn to pass between");
    return wrap.tangent_angle(spacing, crossed_crimp);
}

} // namespace

YarnAxis::YarnAxis(std::span<const uint8_t> above, double spacing, const WrapCurve& wrap,
                   double own_crimp, double crossed_crimp)
    : wrap_(wrap), arc_(wrap, contact_angle(above, spacing, wrap, crossed_crimp)),
      period_(spacing * above.size()) {
    const double angle = arc_.angle(arc_.length());
    const glm::dvec2 last_contact = wrap_.point(angle);
    smallest_curvature_radius_ =
        angle > 0 ? std::min(wrap_.curvature_radius(0), wrap_.curvature_radius(angle))
                  : std::numeric_limits<double>::infinity();

    double interval_start = 0;
    for (size_t k = 0; k < above.size(); ++k) {
        interval_start = length_;
        const double side = above[k] ? 1 : -1;
        const glm::dvec2 crest((k + 0.5) * spacing, side * own_crimp / 2);
        if (above[k] == above[(k + 1) % above.size()]) {
            append(Kind::straight, spacing, crest, 0, 0);
            continue;
        }
        const glm::dvec2 centre(crest.x, -side * crossed_crimp / 2);
        const glm::dvec2 next_centre(crest.x + spacing, -centre.y);
        const glm::dvec2 leaves = centre + last_contact * glm::dvec2(1, side);
        const glm::dvec2 lands = next_centre - last_contact * glm::dvec2(1, side);
        // Where the yarns are as close as they can be, the line has no length and no direction.
        const double line = dot(lands - leaves, {std::cos(angle), -side * std::sin(angle)});
        append(Kind::leaving_crest, arc_.length(), centre, side, 0);
        append(Kind::straight, std::max(0.0, line), leaves, 0, -side * angle);
        append(Kind::approaching_crest, arc_.length(), next_centre, -side, 0);
        turn_ += 2 * angle;
    }
    // The repeat begins half an interval before the first crossing; intervals are symmetric.
    first_crossing_ = (length_ - interval_start) / 2;
}

void YarnAxis::append(Kind kind, double length, glm::dvec2 origin, double side, double slope) {
    pieces_.push_back({kind, length_, length, origin, side, slope, slope_integral_});
    length_ += length;
    slope_integral_ += kind == Kind::straight        ? slope * length
                       : kind == Kind::leaving_crest ? -side * arc_.angle_integral(length)
                                                     : side * arc_.angle_integral(length);
}

const YarnAxis::Piece& YarnAxis::piece_at(double s) const {
    const auto above = std::upper_bound(pieces_.begin() + 1, pieces_.end(), s,
                                        [](double x, const Piece& p) { return x < p.start; });
    return *(above - 1);
}

YarnAxis::Point YarnAxis::at(double s) const {
    s -= first_crossing_;
    const double repeats = std::floor(s / length_);
    s -= repeats * length_;
    const Piece& piece = piece_at(s);
    const double t = s - piece.start;
    if (piece.kind == Kind::straight) {
        const glm::dvec2 p =
            piece.origin + t * glm::dvec2(std::cos(piece.slope), std::sin(piece.slope));
        return {p.x + repeats * period_, p.y, piece.slope};
    }
    const double forward = piece.kind == Kind::leaving_crest ? 1 : -1;
    const double angle = arc_.angle(forward > 0 ? t : piece.length - t);
    const glm::dvec2 p = piece.origin + wrap_.point(angle) * glm::dvec2(forward, piece.side);
    return {p.x + repeats * period_, p.y, -forward * piece.side * angle};
}

double YarnAxis::slope_integral(double s) const {
    s -= first_crossing_;
    const double repeats = std::floor(s / length_);
    s -= repeats * length_;
    const Piece& piece = piece_at(s);
    const double t = s - piece.start;
    double integral = repeats * slope_integral_ + piece.slope_integral;
    switch (piece.kind) {
    case Kind::straight:
        integral += piece.slope * t;
        break;
    case Kind::leaving_crest:
        integral -= piece.side * arc_.angle_integral(t);
        break;
    case Kind::approaching_crest:
        integral += piece.side *
                    (arc_.angle_integral(piece.length) - arc_.angle_integral(piece.length - t));
        break;
    }
    return integral;
}

double YarnAxis::mean_slope(double s, double window) const {
    if (window == 0)
        return at(s).slope;
    return (slope_integral(s + window / 2) - slope_integral(s - window / 2)) / window;
}

} // namespace rapport
