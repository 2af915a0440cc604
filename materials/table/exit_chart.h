#pragma once

#include "renderer/core/math.h"

#include <algorithm>
#include <cstdint>

namespace rapport {

/// The yarns about whose cone exits are charted.
enum class ConeAxis : uint8_t { warp = 0, weft = 1 };

/// A point of an ExitChart: u and v in [−1, 1].
struct ChartPoint {
    double u, v;
};

/// Coordinates of exits in which the highlight of a woven cloth stands still while the light moves.
///
/// A fibre sends what it scatters onto a cone about its axis, mirrored at the plane across it:
/// sin θ_out = −sin θ_in, angles to that plane (Marschner et al. 2003). With warp along y and weft
/// along x, yarns that lie flat light up on y = −y_in and x = −x_in, in reflection and in
/// transmission. One of the two ridges is the stronger, that of the yarns which a side shows more
/// of, and is charted; both at once cannot be made straight, and to slide along the other as well,
/// to the mirror direction, costs the first more than it gives the second
/// (tests/bench/charts/parameterisation.svg). About the warp: over y and the angle ψ round it,
/// atan2(x, |z|), which chart a hemisphere by equal areas, v is ψ over π/2 and u slides y, linearly
/// to either side, so that the ridge is u = 0 whatever the light. About the weft x and y change
/// places. Either half of the square has one ratio of solid angle to area, and each hemisphere is
/// mapped onto the whole square, one to one: what is moved with the chart keeps its energy and its
/// side.
class ExitChart {
  public:
    /// How far from the middle the ridge may lie, in y, to be slid to it; nearer to the horizon it
    /// is slid from here: between a ridge near the horizon and the horizon itself, bins would be so
    /// small that the few paths that end there decided the measured error.
    static constexpr double kFarthest = 0.97;

    /// For light from (or an eye at) the unit vector `towards`; the sign of z does not matter.
    explicit ExitChart(const glm::dvec3& towards, ConeAxis axis = ConeAxis::warp)
        : along_(axis == ConeAxis::warp ? 1 : 0),
          ridge_(std::clamp(-towards[along_], -kFarthest, kFarthest)), length_{1 + ridge_,
                                                                               1 - ridge_} {}

    /// Of the unit vector `w`, on its own hemisphere.
    ChartPoint point(const glm::dvec3& w) const {
        const double beside = w[along_] - ridge_;
        return {std::clamp(beside / length_[beside < 0 ? 0 : 1], -1.0, 1.0),
                std::atan2(w[1 - along_], std::abs(w.z)) / (kPi / 2)};
    }

    /// The unit vector there, on the hemisphere of +z.
    glm::dvec3 direction(const ChartPoint& p) const {
        glm::dvec3 w;
        w[along_] = ridge_ + p.u * length_[p.u < 0 ? 0 : 1];
        const double across = safe_sqrt((1 - w[along_]) * (1 + w[along_]));
        w[1 - along_] = across * std::sin(p.v * (kPi / 2));
        w.z = across * std::sin((1 - std::abs(p.v)) * (kPi / 2));
        return w;
    }

    /// Area of (u, v) per solid angle [1/sr], constant on either side of the ridge.
    double density(const ChartPoint& p) const { return 2 / kPi / length_[p.u < 0 ? 0 : 1]; }

  private:
    int along_; ///< the coordinate that runs along the yarns
    double ridge_;
    double length_[2]; ///< of what lies below the ridge and above
};

} // namespace rapport
