#include "renderer/kernel/fibre_tracer.h"

#include "renderer/kernel/cylinder.h"
#include "renderer/kernel/fibre_block.h"

#include <algorithm>

namespace rapport::kernel {

/// A ray starts in the base cell of the block; what leaves the block without a hit is moved back
/// into the base cell by whole periods and goes on.
struct FibreTracer::Implementation {
    FibreBlock block;

    FibrePoint surface_point(uint32_t number, const CylinderCrossing& crossing,
                             const glm::dvec3& origin, const glm::dvec3& direction,
                             double distance) const {
        return {origin + direction * distance,
                outward_normal(block.segments()[number], crossing, distance), number, distance};
    }

    Entry enter(glm::dvec3 origin, const glm::dvec3& direction, uint32_t leaving) const;
    Entry meet(const FibreBlock::Ray& ray, const FibreBlock::Found& found, double travelled) const;
    FibrePoint leave(glm::dvec3 origin, const glm::dvec3& direction, uint32_t number) const;
};

FibreTracer::Entry FibreTracer::Implementation::enter(glm::dvec3 origin,
                                                      const glm::dvec3& direction,
                                                      uint32_t leaving) const {
    constexpr double kFarthest2 = 1e15; // also refuses what is not finite
    if (!(glm::dot(origin, origin) < kFarthest2) || !(glm::dot(direction, direction) < 2))
        return {Flight::lost, false, {}};
    const double entrance = direction.z > 0 ? block.z_min() : block.z_max();
    const double exit = direction.z > 0 ? block.z_max() : block.z_min();
    double travelled = 0;
    if ((entrance - origin.z) * direction.z > 0) { // still outside the cloth
        travelled = (entrance - origin.z) / direction.z;
        origin += direction * travelled;
    }
    FibreBlock::Ray ray{{}, direction, 0, leaving, block.wrap(origin), leaving != kNone};
    const double overlap_of_flights = 4 * block.tolerance();
    for (int wraps = 0; wraps <= kMaxWraps; ++wraps) {
        const double to_exit = direction.z != 0 ? (exit - origin.z) / direction.z
                                                : std::numeric_limits<double>::infinity();
        if (to_exit < 0)
            return {Flight::leaves, false, {}};
        const double to_side = block.distance_to_side(origin, direction);
        ray.origin = origin;
        ray.reach = std::min(to_exit, to_side) + overlap_of_flights;
        if (const std::optional<FibreBlock::Found> found = block.find(ray))
            return meet(ray, *found, travelled);
        if (to_exit <= to_side)
            return {Flight::leaves, false, {}};
        const double step = to_side - overlap_of_flights;
        travelled += step;
        origin += direction * step;
        block.wrap(origin);
        ray.leaving = kNone;
        ray.test_overlap = false;
    }
    return {Flight::lost, false, {}};
}

FibreTracer::Entry FibreTracer::Implementation::meet(const FibreBlock::Ray& ray,
                                                     const FibreBlock::Found& found,
                                                     double travelled) const {
    const glm::dvec3 origin = ray.origin - block.offset(found.shift);
    if (found.around) {
        FibrePoint point = leave(origin, -ray.direction, found.segment);
        point.distance = -point.distance;
        return {Flight::enters, true, point};
    }
    const CylinderCrossing crossing = cross(block.segments()[found.segment], origin, ray.direction);
    FibrePoint point = surface_point(found.segment, crossing, origin, ray.direction,
                                     std::max(0.0, crossing.entry()));
    point.distance += travelled;
    return {Flight::enters, false, point};
}

FibrePoint FibreTracer::Implementation::leave(glm::dvec3 origin, const glm::dvec3& direction,
                                              uint32_t number) const {
    for (int step = 0;; ++step) {
        const FibreSegment& segment = block.segments()[number];
        const CylinderCrossing crossing = cross(segment, origin, direction);
        const double exit = crossing.exit();
        const glm::dvec3 from_start = origin - segment.start;
        // Only a plane that the ray approaches can be crossed: what rounding has put a little
        // beyond one, on its way back, is not sent to and fro.
        const double towards_start = -glm::dot(direction, segment.start_normal);
        const double towards_end = glm::dot(direction, segment.end_normal);
        const double to_start = glm::dot(from_start, segment.start_normal);
        const double to_end = segment.end_offset - glm::dot(from_start, segment.end_normal);
        const bool past_start = towards_start > 0 && exit * towards_start > to_start;
        const bool past_end = towards_end > 0 && exit * towards_end > to_end;
        if (!past_start && !past_end)
            return surface_point(number, crossing, origin, direction, std::max(0.0, exit));
        const bool forwards =
            past_end && !(past_start && to_start * towards_end < to_end * towards_start);
        if (step == kMaxSteps) {
            const double to_joint = forwards ? to_end / towards_end : to_start / towards_start;
            return surface_point(number, crossing, origin, direction, std::max(0.0, to_joint));
        }
        // Across the closure of the chain, the neighbour is stored one period away.
        if (forwards && segment.next <= number)
            origin -= block.period(segment);
        else if (!forwards && segment.previous >= number)
            origin += block.period(segment);
        number = forwards ? segment.next : segment.previous;
    }
}

FibreTracer::FibreTracer(const FibreAssembly& assembly, const StopSignal& stopped)
    : implementation_(new Implementation{FibreBlock(assembly, stopped)}) {}
FibreTracer::~FibreTracer() = default;
FibreTracer::FibreTracer(FibreTracer&&) noexcept = default;

double FibreTracer::memory(double segments, const glm::dvec2& cell, double thickness) {
    return FibreBlock::memory(segments, cell, thickness);
}

FibreTracer::Entry FibreTracer::enter(const glm::dvec3& origin, const glm::dvec3& direction,
                                      uint32_t leaving) const {
    return implementation_->enter(origin, direction, leaving);
}

FibrePoint FibreTracer::leave(const glm::dvec3& origin, const glm::dvec3& direction,
                              uint32_t segment) const {
    return implementation_->leave(origin, direction, segment);
}

glm::dvec2 FibreTracer::cell() const { return implementation_->block.cell(); }
double FibreTracer::z_min() const { return implementation_->block.z_min(); }
double FibreTracer::z_max() const { return implementation_->block.z_max(); }
std::span<const FibreSegment> FibreTracer::segments() const {
    return implementation_->block.segments();
}

} // namespace rapport::kernel
