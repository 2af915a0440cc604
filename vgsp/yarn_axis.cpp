#include "vgsp/yarn_axis.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace rapport {
namespace {

constexpr double kRounding = 1e-9; ///< relative; what a spacing that just suffices may lack

std::vector<YarnAxis::Crossing> crossings_of(std::span<const uint8_t> above, const WrapCurve& wrap,
                                             double crossed_crimp) {
    std::vector<YarnAxis::Crossing> crossings;
    for (const uint8_t over : above)
        crossings.push_back({over != 0, &wrap, crossed_crimp});
    return crossings;
}

} // namespace

YarnAxis::YarnAxis(std::span<const uint8_t> above, double spacing, const WrapCurve& wrap,
                   double own_crimp, double crossed_crimp)
    : YarnAxis(crossings_of(above, wrap, crossed_crimp), spacing, own_crimp) {}

YarnAxis::YarnAxis(std::span<const Crossing> crossings, double spacing, double own_crimp)
    : period_(spacing * crossings.size()) {
    struct Solved {
        const WrapCurve *from, *to;
        double rise, angle;
    };
    std::vector<Solved> solved; // few: passages repeat
    const auto contact_angle = [&](const Crossing& here, const Crossing& next) {
        const double rise = 0.5 * (here.crimp + next.crimp);
        for (const Solved& s : solved)
            if (s.from == here.wrap && s.to == next.wrap && s.rise == rise)
                return s.angle;
        const WrapPassage passage(*here.wrap, *next.wrap, rise);
        if (!(spacing >= passage.smallest_spacing() * (1 - kRounding)))
            throw std::invalid_argument(
                "the crossed yarns are too close for a yarn to pass between");
        solved.push_back({here.wrap, next.wrap, rise, passage.tangent_angle(spacing)});
        return solved.back().angle;
    };
    double interval_start = 0;
    for (size_t k = 0; k < crossings.size(); ++k) {
        interval_start = length_;
        const Crossing &here = crossings[k], &next = crossings[(k + 1) % crossings.size()];
        const double side = here.above ? 1 : -1;
        const glm::dvec2 crest((k + 0.5) * spacing, side * own_crimp / 2);
        if (here.above == next.above) {
            append(Kind::straight, spacing, crest, 0, 0);
            continue;
        }
        const double angle = contact_angle(here, next);
        const size_t leaving = arc_to(*here.wrap, angle), landing = arc_to(*next.wrap, angle);
        const glm::dvec2 centre(crest.x, -side * here.crimp / 2);
        const glm::dvec2 next_centre(crest.x + spacing, side * next.crimp / 2);
        const auto contact = [&](size_t arc) {
            return arcs_[arc].curve.point(arcs_[arc].arc.angle(arcs_[arc].arc.length()));
        };
        const glm::dvec2 leaves = centre + contact(leaving) * glm::dvec2(1, side);
        const glm::dvec2 lands = next_centre - contact(landing) * glm::dvec2(1, side);
        // Where the yarns are as close as they can be, the line has no length and no direction.
        const double line = dot(lands - leaves, {std::cos(angle), -side * std::sin(angle)});
        append(Kind::leaving_crest, arcs_[leaving].arc.length(), centre, side, 0, leaving);
        append(Kind::straight, std::max(0.0, line), leaves, 0, -side * angle);
        append(Kind::approaching_crest, arcs_[landing].arc.length(), next_centre, -side, 0,
               landing);
        turn_ += 2 * angle;
    }
    first_crossing_ = (length_ - interval_start) / 2;
}

/// The index in arcs_ of the arc of `curve` from its crest to that angle.
size_t YarnAxis::arc_to(const WrapCurve& curve, double end_angle) {
    for (size_t i = 0; i < arcs_.size(); ++i)
        if (arcs_[i].curve == curve && arcs_[i].end_angle == end_angle)
            return i;
    arcs_.push_back({curve, end_angle, WrapArc(curve, end_angle)});
    if (end_angle > 0)
        smallest_curvature_radius_ =
            std::min({smallest_curvature_radius_, curve.curvature_radius(0),
                      curve.curvature_radius(end_angle)});
    return arcs_.size() - 1;
}

void YarnAxis::append(Kind kind, double length, glm::dvec2 origin, double side, double slope,
                      size_t arc) {
    pieces_.push_back({kind, length_, length, origin, side, slope, slope_integral_, arc});
    length_ += length;
    slope_integral_ += kind == Kind::straight        ? slope * length
                       : kind == Kind::leaving_crest ? -side * arcs_[arc].arc.angle_integral(length)
                                                     : side * arcs_[arc].arc.angle_integral(length);
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
    const auto& [curve, end_angle, arc] = arcs_[piece.arc];
    const double angle = arc.angle(forward > 0 ? t : piece.length - t);
    const glm::dvec2 p = piece.origin + curve.point(angle) * glm::dvec2(forward, piece.side);
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
        integral -= piece.side * arcs_[piece.arc].arc.angle_integral(t);
        break;
    case Kind::approaching_crest:
        integral += piece.side * (arcs_[piece.arc].arc.angle_integral(piece.length) -
                                  arcs_[piece.arc].arc.angle_integral(piece.length - t));
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
