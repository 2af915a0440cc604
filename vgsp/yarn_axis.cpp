#include "vgsp/yarn_axis.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace rapport {
namespace {

constexpr double kRounding = 1e-9; ///< relative; what a spacing that just suffices may lack
constexpr double kNoTurn = 1e-9;   ///< [rad]

double side_of(const YarnAxis::Crossing& crossing) { return crossing.above ? 1 : -1; }

double line_slope(const YarnAxis::Crossing& from, const YarnAxis::Crossing& to, double spacing) {
    const WrapPassage passage({&from.wrap->curve(), from.above}, {&to.wrap->curve(), to.above},
                              to.centre - from.centre);
    if (!(spacing >= passage.smallest_spacing() * (1 - kRounding)))
        throw std::invalid_argument("the crossed yarns are too close for a yarn to pass between");
    return passage.slope(spacing);
}

} // namespace

/// Those that stay of all crossings, when one by one those go whose section lies clear of the line
/// between its neighbours.
std::vector<YarnAxis::Touched> YarnAxis::touched(std::span<const Crossing> crossings,
                                                 double spacing) {
    const size_t count = crossings.size();
    std::vector<size_t> next(count), previous(count);
    std::vector<double> leaving(count);
    const auto join = [&](size_t from, size_t to) {
        next[from] = to;
        previous[to] = from;
        const size_t intervals = (to + count - from - 1) % count + 1;
        leaving[from] = line_slope(crossings[from], crossings[to], intervals * spacing);
    };
    for (size_t k = 0; k < count; ++k)
        join(k, (k + 1) % count);

    size_t remaining = count, k = 0;
    for (size_t settled = 0; settled < remaining;) {
        const double turn =
            side_of(crossings[k]) * (leaving[previous[k]] - leaving[k]); // towards the section
        if (turn >= -kNoTurn || remaining == 1) {
            ++settled;
            k = next[k];
            continue;
        }
        const size_t before = previous[k];
        join(before, next[k]);
        k = before; // where another line leaves now
        --remaining;
        settled = 0;
    }
    while (next[k] > k)
        k = next[k];
    k = next[k]; // the first
    std::vector<Touched> result;
    for (size_t step = 0; step < remaining; ++step, k = next[k])
        result.push_back({k, next[k], leaving[previous[k]], leaving[k]});
    return result;
}

YarnAxis::YarnAxis(std::span<const Crossing> crossings, double spacing)
    : crossing_slopes_(crossings.size()), period_(spacing * crossings.size()) {
    const size_t count = crossings.size();
    const std::vector<Touched> all = touched(crossings, spacing);
    const auto along = [&](size_t k) { return (k + 0.5) * spacing; };
    const auto on_arc = [&](size_t k, double slope) {
        const double side = side_of(crossings[k]);
        return glm::dvec2(along(k), crossings[k].centre) +
               crossings[k].wrap->curve().point(-side * slope) * glm::dvec2(1, side);
    };
    for (const Touched& t : all) {
        append_arc(crossings[t.crossing], along(t.crossing), t.slope_in, t.slope_out);
        const glm::dvec2 wound(t.next > t.crossing ? 0 : period_, 0);
        append_line(on_arc(t.crossing, t.slope_out), on_arc(t.next, t.slope_out) + wound,
                    t.slope_out);
        const bool crest = t.slope_in * t.slope_out <= 0;
        crossing_slopes_[t.crossing] =
            crest
                ? 0
                : std::copysign(std::min(std::abs(t.slope_in), std::abs(t.slope_out)), t.slope_in);
        for (size_t k = (t.crossing + 1) % count; k != t.next; k = (k + 1) % count)
            crossing_slopes_[k] = t.slope_out;
        turn_ += std::abs(t.slope_out - t.slope_in);
    }

    double low = -2 * length_, high = 2 * length_;
    for (int step = 0; step < 100; ++step) {
        const double middle = 0.5 * (low + high);
        (from_first_piece(middle).along < 0 ? low : high) = middle;
    }
    origin_ = -high;
}

void YarnAxis::append_arc(const Crossing& crossing, double along, double slope_in,
                          double slope_out) {
    const double side = side_of(crossing);
    const double first = -side * slope_in, last = std::max(first, -side * slope_out);
    const WrapCurve& curve = crossing.wrap->curve();
    if (first <= 0 && last >= 0) {
        const double crest = crossing.centre + side * curve.support(0);
        highest_ = std::max(highest_, crest);
        lowest_ = std::min(lowest_, crest);
    }
    if (!(last - first > kNoTurn))
        return;
    for (const double angle : {first, last, std::clamp(0.0, first, last)})
        smallest_curvature_radius_ =
            std::min(smallest_curvature_radius_, curve.curvature_radius(angle));
    if (std::ranges::find(wraps_, crossing.wrap) == wraps_.end())
        wraps_.push_back(crossing.wrap);
    const double begin = crossing.wrap->length(first), end = crossing.wrap->length(last);
    pieces_.push_back({length_, slope_integral_, glm::dvec2(along, crossing.centre),
                       crossing.wrap.get(), side, begin});
    slope_integral_ += slope_integral_in(pieces_.back(), end - begin);
    length_ += end - begin;
}

void YarnAxis::append_line(glm::dvec2 from, glm::dvec2 to, double slope) {
    // Where the yarns are as close as they can be, the line has no length and no direction.
    const double line = std::max(0.0, dot(to - from, {std::cos(slope), std::sin(slope)}));
    highest_ = std::max({highest_, from.y, to.y});
    lowest_ = std::min({lowest_, from.y, to.y});
    pieces_.push_back({length_, slope_integral_, from, nullptr, 0, slope});
    slope_integral_ += slope * line;
    length_ += line;
}

/// ∫ slope ds over the first `t` of a piece.
double YarnAxis::slope_integral_in(const Piece& piece, double t) const {
    if (!piece.wrap)
        return piece.first * t;
    return -piece.side *
           (piece.wrap->angle_integral(piece.first + t) - piece.wrap->angle_integral(piece.first));
}

const YarnAxis::Piece& YarnAxis::piece_at(double s) const {
    const auto above = std::upper_bound(pieces_.begin() + 1, pieces_.end(), s,
                                        [](double x, const Piece& p) { return x < p.start; });
    return *(above - 1);
}

YarnAxis::Point YarnAxis::from_first_piece(double s) const {
    const double repeats = std::floor(s / length_);
    s -= repeats * length_;
    const Piece& piece = piece_at(s);
    const double t = s - piece.start;
    if (!piece.wrap) {
        const double slope = piece.first;
        const glm::dvec2 p = piece.origin + t * glm::dvec2(std::cos(slope), std::sin(slope));
        return {p.x + repeats * period_, p.y, slope};
    }
    const double angle = piece.wrap->angle(piece.first + t);
    const glm::dvec2 p =
        piece.origin + piece.wrap->curve().point(angle) * glm::dvec2(1, piece.side);
    return {p.x + repeats * period_, p.y, -piece.side * angle};
}

YarnAxis::Point YarnAxis::at(double s) const { return from_first_piece(s - origin_); }

double YarnAxis::slope_integral(double s) const {
    s -= origin_;
    const double repeats = std::floor(s / length_);
    s -= repeats * length_;
    const Piece& piece = piece_at(s);
    return repeats * slope_integral_ + piece.slope_integral +
           slope_integral_in(piece, s - piece.start);
}

double YarnAxis::mean_slope(double s, double window) const {
    if (window == 0)
        return at(s).slope;
    return (slope_integral(s + window / 2) - slope_integral(s - window / 2)) / window;
}

} // namespace rapport
