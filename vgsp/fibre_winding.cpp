#include "vgsp/fibre_winding.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace rapport {
namespace {

using glm::dvec3;

constexpr double kNoCrimp = 1e-6;   ///< half a yarn's rise and fall over its half height
constexpr int kMostRefinement = 64; ///< beyond which a curve cannot be smooth

double angle_between(const dvec3& a, const dvec3& b) {
    return std::atan2(length(cross(a, b)), dot(a, b));
}

/// The largest turn of the closed chain.
double largest_turn(const std::vector<dvec3>& points, const dvec3& period) {
    const size_t n = points.size();
    const auto point = [&](size_t k) { return points[k % n] + double(k / n) * period; };
    double largest = 0;
    for (size_t k = 0; k < n; ++k)
        largest =
            std::max(largest, angle_between(point(k + 1) - point(k), point(k + 2) - point(k + 1)));
    return largest;
}

/// The measure of the curve that joints divide equally, at equal steps of its parameter.
std::vector<double> joint_measure(const ClosedCurve& curve, const JointSpacing& spacing) {
    const int n = std::max(8, int(std::ceil(curve.length / curve.sampling_step)));
    std::vector<dvec3> steps(n);
    dvec3 here = curve.at(0);
    for (int k = 0; k < n; ++k) {
        const dvec3 next = curve.at(curve.length * (k + 1) / n);
        steps[k] = next - here;
        here = next;
    }
    std::vector<double> turns(n); // from step k − 1 to step k
    for (int k = 0; k < n; ++k)
        turns[k] = angle_between(steps[(k + n - 1) % n], steps[k]);

    // The largest turn nearby counts: a segment that begins on a float and ends in a bend then
    // stays as short as the bend asks.
    std::vector<double> measure{0};
    for (int k = 0; k < n; ++k) {
        const double turn =
            std::max({turns[(k + n - 1) % n], turns[k], turns[(k + 1) % n], turns[(k + 2) % n]});
        measure.push_back(measure.back() + turn / spacing.max_turn +
                          length(steps[k]) / spacing.max_length);
    }
    return measure;
}

} // namespace

dvec3 PlacedYarn::fibre_point(const FibreSite& fibre, double s) const {
    const bool wound = twist != 0 || ply_twist != 0 || !migration.empty() || fibre.loop.height > 0;
    const YarnAxis::Point axis_point = axis->at(s);
    const double slope =
        wound ? axis->mean_slope(s, section->outline.half_height) : axis_point.slope;
    glm::dvec2 p = section->place(fibre.position, fibre.turns[0].in_single + twist * s,
                                  fibre.turns[0].in_ply + ply_twist * s);
    if (!migration.empty())
        p += migration.at(p, s);
    if (fibre.loop.height > 0)
        p += stray(fibre.loop, p, s, axis_point.height);
    const dvec3 up(0, 0, 1);
    return origin + (axis_point.along - std::sin(slope) * p.y) * direction +
           (axis_point.height + std::cos(slope) * p.y) * up + p.x * cross(direction, up);
}

glm::dvec2 PlacedYarn::stray(const StrayLoop& loop, const glm::dvec2& p, double s,
                             double height) const {
    const double middle = 0.5 * (axis->highest() + axis->lowest());
    const double crest = axis->highest() - middle, distance = length(p);
    const glm::dvec2 size(section->outline.half_width, section->outline.half_height);
    const double facing_out = (height - middle) * p.y / (crest * distance);
    if (!(crest > kNoCrimp * size.y && facing_out > 0))
        return glm::dvec2(0);
    const double outside = glm::smoothstep(0.5, 0.9, length(p / size));
    return loop.height_at(s) * outside * facing_out * facing_out / distance * p;
}

std::vector<dvec3> place_joints(const ClosedCurve& curve, const JointSpacing& spacing,
                                double dither) {
    const std::vector<double> measure = joint_measure(curve, spacing);
    const int steps = int(measure.size()) - 1;
    const auto joints = [&](int count) {
        std::vector<dvec3> points;
        points.reserve(count);
        int step = 0;
        for (int k = 0; k < count; ++k) {
            const double target = measure.back() * (k + dither) / count;
            while (step + 1 < steps && measure[step + 1] <= target)
                ++step;
            const double part = (target - measure[step]) / (measure[step + 1] - measure[step]);
            points.push_back(curve.at(curve.length * (step + part) / steps));
        }
        return points;
    };
    // Sampling finds the turn to within some percent; what is missing is made good here.
    const int first = std::max(1, int(std::ceil(measure.back())));
    for (int count = first; count <= kMostRefinement * first;) {
        std::vector<dvec3> points = joints(count);
        const double excess = largest_turn(points, curve.period) / spacing.max_turn;
        if (excess <= 1)
            return points;
        count = std::max(count + 1, int(count * std::min(excess, 1.5)));
    }
    throw std::logic_error("a fibre's curve has a kink");
}

} // namespace rapport
