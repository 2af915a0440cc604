#pragma once

#include "materials/table/fast_angles.h"
#include "renderer/core/math.h"

#include <algorithm>

namespace rapport {

/// A point of an ExitChart: u and v in [−1, 1].
template <class T> struct ChartPoint { T u, v; };

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
///
/// T = double (the goniophotometer), or float (looking up; angles by polynomials within 2e-6).
template <class T> class ExitChart {
  public:
    /// How far from the middle a mirror direction may lie, in y and in quarter turns of ψ, to
    /// become the origin; nearer to the horizon the origin stays here.
    static constexpr double kFarthest = 0.97;

    /// For light from (or an eye at) the unit vector `towards`; the sign of z does not matter.
    explicit ExitChart(const Vector3<T>& towards)
        : u_(-towards.y), v_(-quarter_turns(towards.x, std::abs(towards.z))) {}

    /// Of the unit vector `w`, on its own hemisphere.
    ChartPoint<T> point(const Vector3<T>& w) const {
        return {u_.still(w.y), v_.still(quarter_turns(w.x, std::abs(w.z)))};
    }

    /// The unit vector there, on the hemisphere of +z.
    Vector3<T> direction(const ChartPoint<T>& p) const {
        const T y = u_.moved(p.u), turn = v_.moved(p.v);
        const T across = safe_sqrt((1 - y) * (1 + y));
        return {across * sine(turn), y, across * sine(1 - std::abs(turn))};
    }

    /// Area of (u, v) per solid angle [1/sr], constant in each quadrant.
    T density(const ChartPoint<T>& p) const {
        return T(2 / kPi) * u_.inverse[p.u < 0 ? 0 : 1] * v_.inverse[p.v < 0 ? 0 : 1];
    }

  private:
    /// A coordinate on [−1, 1] that is slid until `origin` is 0.
    struct Slide {
        T origin, length[2], inverse[2]; ///< of the sides below and above

        /// Off ±1: between a mirror direction near the horizon and the horizon itself, bins would
        /// be so small that the few paths that end there decided the measured error.
        explicit Slide(T x)
            : origin(std::clamp(x, T(-kFarthest), T(kFarthest))), length{1 + origin, 1 - origin},
              inverse{1 / length[0], 1 / length[1]} {}
        T still(T x) const {
            const T offset = x - origin;
            return std::clamp(offset * inverse[offset < 0 ? 0 : 1], T(-1), T(1));
        }
        T moved(T still) const { return origin + still * length[still < 0 ? 0 : 1]; }
    };

    /// atan2(x, z) over π/2, z ≥ 0, and the sine of such an angle in [−1, 1].
    static T quarter_turns(T x, T z);
    static T sine(T quarter_turns);

    Slide u_, v_;
};

template <> inline double ExitChart<double>::quarter_turns(double x, double z) {
    return std::atan2(x, z) / (kPi / 2);
}
template <> inline float ExitChart<float>::quarter_turns(float x, float z) {
    return fast_quarter_turns(x, z);
}
template <> inline double ExitChart<double>::sine(double quarter_turns) {
    return std::sin(quarter_turns * (kPi / 2));
}
template <> inline float ExitChart<float>::sine(float quarter_turns) {
    return fast_sine(quarter_turns);
}

} // namespace rapport
