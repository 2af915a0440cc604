#pragma once

#include "renderer/core/math.h"

#include <algorithm>

namespace rapport {

/// A point of an ExitChart: u and v in [−1, 1].
struct ChartPoint {
    double u, v;
};

/// Coordinates of exits in which the highlights of a woven cloth stand still while the light moves.
///
/// A fibre sends what it scatters onto a cone about its axis, mirrored at the plane across it:
/// sin θ_out = −sin θ_in, angles to that plane (Marschner et al. 2003). With warp along y and weft
/// along x, yarns that lie flat light up on y = −y_in and x = −x_in, in reflection and in
/// transmission, and the two ridges cross in the mirror direction. Over y and the angle ψ round the
/// warp, atan2(x, |z|), which chart a hemisphere by equal areas, u slides y and v slides ψ,
/// linearly to either side, so that the mirror direction is the origin: the warp's ridge is u = 0
/// whatever the light, the weft's stays close to v = 0. Each quadrant of (u, v) has one ratio of
/// solid angle to area, and each hemisphere is mapped onto the whole square, one to one: what is
/// moved with the chart keeps its energy and its side.
class ExitChart {
  public:
    /// How far from the middle a mirror direction may lie, in y and in quarter turns of ψ, to
    /// become the origin; nearer to the horizon the origin stays here: between a mirror direction
    /// near the horizon and the horizon itself, bins would be so small that the few paths that end
    /// there decided the measured error.
    static constexpr double kFarthest = 0.97;

    /// For light from (or an eye at) the unit vector `towards`; the sign of z does not matter.
    explicit ExitChart(const glm::dvec3& towards) : u_(-towards.y), v_(-quarter_turns(towards)) {}

    /// Of the unit vector `w`, on its own hemisphere.
    ChartPoint point(const glm::dvec3& w) const {
        return {u_.still(w.y), v_.still(quarter_turns(w))};
    }

    /// The unit vector there, on the hemisphere of +z.
    glm::dvec3 direction(const ChartPoint& p) const {
        const double y = u_.moved(p.u), turn = v_.moved(p.v);
        const double across = safe_sqrt((1 - y) * (1 + y));
        return {across * std::sin(turn * (kPi / 2)), y,
                across * std::sin((1 - std::abs(turn)) * (kPi / 2))};
    }

    /// Area of (u, v) per solid angle [1/sr], constant in each quadrant.
    double density(const ChartPoint& p) const {
        return 2 / kPi * u_.inverse[p.u < 0 ? 0 : 1] * v_.inverse[p.v < 0 ? 0 : 1];
    }

  private:
    /// A coordinate on [−1, 1] that is slid until `origin` is 0.
    struct Slide {
        double origin, length[2], inverse[2]; ///< of the sides below and above

        explicit Slide(double x)
            : origin(std::clamp(x, -kFarthest, kFarthest)), length{1 + origin, 1 - origin},
              inverse{1 / length[0], 1 / length[1]} {}
        double still(double x) const {
            const double offset = x - origin;
            return std::clamp(offset * inverse[offset < 0 ? 0 : 1], -1.0, 1.0);
        }
        double moved(double still) const { return origin + still * length[still < 0 ? 0 : 1]; }
    };

    /// ψ over π/2.
    static double quarter_turns(const glm::dvec3& w) {
        return std::atan2(w.x, std::abs(w.z)) / (kPi / 2);
    }

    Slide u_, v_;
};

} // namespace rapport
