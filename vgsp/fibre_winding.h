#pragma once

#include "renderer/kernel/fibres.h"
#include "vgsp/fibre_scatter.h"
#include "vgsp/yarn_axis.h"

#include <functional>

namespace rapport {

/// A yarn in the micro-element: its axis placed in space, and its section wound round it.
struct PlacedYarn {
    const YarnAxis* axis;
    const SectionLayout* section;
    glm::dvec3 origin;       ///< of the axis' coordinates
    glm::dvec3 direction;    ///< unit, in the plane of the cloth
    double twist, ply_twist; ///< [rad/µm of axis], Z positive
    MigrationField migration;

    /// The axis of the fibre at arc length `s` of the yarn's axis, in the turn of its first cell.
    /// The section stands across the axis; for a fibre that does not keep its place in it, because
    /// of twist or irregularity, across the mean direction of the axis over one yarn radius: else
    /// the fibre would kink by several degrees where an arc ends and the curvature jumps. This
    /// shifts fibres along the yarn; the outline changes in second order only (≤ 0.2 % of the
    /// radius).
    glm::dvec3 fibre_point(const FibreSite& fibre, double s) const;

  private:
    /// How far a stray fibre at `p` of the section loops outwards: in full at the outline where it
    /// faces away from the crossed yarn, not at all where it faces it or lies inside the yarn, or
    /// in a yarn without crimp.
    glm::dvec2 stray(const StrayLoop& loop, const glm::dvec2& p, double s, double height) const;
};

/// A smooth curve that closes: at(s + length) = at(s) + a period.
struct ClosedCurve {
    std::function<glm::dvec3(double)> at;
    double length;        ///< of the parameter [µm]
    double sampling_step; ///< of the parameter, in which the curve turns little
    glm::dvec3 period;
};

struct JointSpacing {
    double max_turn;   ///< between the directions of two successive segments [rad]
    double max_length; ///< of a segment [µm]
};

/// Points of the curve in order, so that the closed chain through them keeps to `spacing`: at
/// equal steps of turn ÷ max_turn + length ÷ max_length, dense in bends and sparse on floats.
/// `dither` ∈ [0, 1) shifts them along by a share of a step. Throws std::logic_error for a curve
/// with a kink, which no number of joints would bring within `spacing`.
std::vector<glm::dvec3> place_joints(const ClosedCurve& curve, const JointSpacing& spacing,
                                     double dither);

} // namespace rapport
