#pragma once

#include "renderer/core/math.h"
#include "renderer/core/stop_signal.h"

#include <cstdint>
#include <vector>

namespace rapport::kernel {

/// A fibre: a closed chain of straight, round cylinders of one radius, neighbours cut by the plane
/// that bisects their directions. `points` are the joints on the fibre's axis; the chain closes
/// from the last point to points[0] + period.
struct FibreChain {
    std::vector<glm::dvec3> points;
    glm::dvec3 period; ///< a whole number of cells along x and y
    double radius;
    uint32_t kind = 0; ///< which fibre material; meaningless to the kernel
};

/// Fibres that repeat with period `cell` along x and y without end. Lengths in any unit in which a
/// fibre radius is near 1 (micrometres); Embree loses precision far from there.
struct FibreAssembly {
    glm::dvec2 cell;
    std::vector<FibreChain> chains;
};

/// One cylinder of a chain, with what a ray needs of it, in double precision.
struct FibreSegment {
    glm::dvec3 start;     ///< on the axis
    glm::dvec3 direction; ///< unit
    double length;
    glm::dvec3 start_normal, end_normal; ///< unit normals of the mitre planes, along the chain
    double end_offset;                   ///< dot(start + direction·length − start, end_normal)
    double radius;
    uint32_t chain;          ///< index into FibreAssembly::chains
    uint32_t previous, next; ///< segment indices along the closed chain
    uint32_t kind;
};

/// The chain's cylinders in order. Throws std::invalid_argument for coincident points, a radius
/// that is not positive, or a period that is no whole number of cells, and Stopped when told to
/// stop, before one of the chains.
std::vector<FibreSegment> fibre_segments(const FibreAssembly& assembly,
                                         const StopSignal& stopped = {});

} // namespace rapport::kernel
