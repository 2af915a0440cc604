#pragma once

#include "renderer/kernel/fibres.h"

#include <limits>
#include <utility>

namespace rapport::kernel {

/// Where a line meets an endless round cylinder: centre ± half, in units of the unit direction.
struct CylinderCrossing {
    double centre, half;
    glm::dvec3 radial,
        across;    ///< from the axis to the origin; the direction's part across the axis
    bool parallel; ///< to the axis: it never crosses the surface

    double entry() const { return centre - half; }
    double exit() const {
        return parallel ? std::numeric_limits<double>::infinity() : centre + half;
    }
};

/// The crossing with `segment`'s cylinder, its mitre planes left aside. A line that rounding, or a
/// hit found in single precision, puts beyond the surface touches it: half = 0.
inline CylinderCrossing cross(const FibreSegment& segment, const glm::dvec3& origin,
                              const glm::dvec3& direction) {
    CylinderCrossing crossing;
    const glm::dvec3 from_start = origin - segment.start;
    crossing.radial = from_start - segment.direction * glm::dot(from_start, segment.direction);
    crossing.across = direction - segment.direction * glm::dot(direction, segment.direction);
    const double across2 = glm::dot(crossing.across, crossing.across);
    crossing.parallel = across2 < 1e-24;
    if (crossing.parallel) {
        crossing.centre = crossing.half = 0;
        return crossing;
    }
    const double inverse = 1 / across2;
    crossing.centre = -glm::dot(crossing.radial, crossing.across) * inverse;
    // From the closest approach, not from the quadratic's coefficients, which would cancel.
    const glm::dvec3 closest = crossing.radial + crossing.across * crossing.centre;
    const double chord2 = square(segment.radius) - glm::dot(closest, closest);
    crossing.half = chord2 > 0 ? std::sqrt(chord2 * inverse) : 0.0;
    return crossing;
}

/// Outward normal of `segment`'s cylinder where the line of `crossing` is at distance `t`.
inline glm::dvec3 outward_normal(const FibreSegment& segment, const CylinderCrossing& crossing,
                                 double t) {
    const glm::dvec3 normal = (crossing.radial + crossing.across * t) / segment.radius;
    const double length2 = glm::dot(normal, normal);
    if (std::abs(length2 - 1) < 1e-7)
        return normal * (1.5 - 0.5 * length2); // a step of Newton's method: no root, no quotient
    return length2 > 0 ? normal / std::sqrt(length2)
                       : BasicFrame<double>::about(segment.direction).x;
}

/// Whether `position` lies strictly inside the mitred cylinder.
inline bool inside(const FibreSegment& segment, const glm::dvec3& position) {
    const glm::dvec3 from_start = position - segment.start;
    if (glm::dot(from_start, segment.start_normal) < 0 ||
        glm::dot(from_start, segment.end_normal) > segment.end_offset)
        return false;
    const glm::dvec3 radial =
        from_start - segment.direction * glm::dot(from_start, segment.direction);
    return glm::dot(radial, radial) < square(segment.radius);
}

/// Lower and upper corner of the mitred cylinder: those of its two end ellipses. The point of an
/// end that is `r·w` off the axis (w a unit vector across it) is shifted along the axis by
/// −r·(w·n)/(u·n), so its extent along a world axis e is r·|e − n·(u·e)/(u·n)|, taken across u.
inline std::pair<glm::dvec3, glm::dvec3> bounds(const FibreSegment& segment) {
    const glm::dvec3& u = segment.direction;
    const auto extent = [&](const glm::dvec3& normal) {
        glm::dvec3 result;
        for (int axis = 0; axis < 3; ++axis) {
            glm::dvec3 support = -normal * (u[axis] / glm::dot(u, normal));
            support[axis] += 1;
            support -= u * glm::dot(u, support);
            result[axis] = segment.radius * glm::length(support);
        }
        return result;
    };
    const glm::dvec3 end = segment.start + u * segment.length;
    const glm::dvec3 at_start = extent(segment.start_normal), at_end = extent(segment.end_normal);
    return {glm::min(segment.start - at_start, end - at_end),
            glm::max(segment.start + at_start, end + at_end)};
}

} // namespace rapport::kernel
