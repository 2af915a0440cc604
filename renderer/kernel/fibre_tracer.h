#pragma once

#include "renderer/core/stop_signal.h"
#include "renderer/kernel/fibres.h"

#include <memory>
#include <span>

namespace rapport::kernel {

/// A point on a fibre's surface. Because everything repeats, the position is given in the period
/// in which segment `segment` is stored.
struct FibrePoint {
    glm::dvec3 position;
    glm::dvec3 normal; ///< unit, outward
    uint32_t segment;
    double distance; ///< travelled from the ray's origin; negative where an overlap shifted it back
};

/// Traces rays among the fibres of an endless periodic assembly: the narrow door behind which any
/// accelerator may stand. Constant after construction; callable from any thread. Directions are of
/// unit length.
class FibreTracer {
  public:
    /// Throws std::invalid_argument as fibre_segments does, and for an assembly without fibres.
    /// Throws Stopped when told to stop while it builds its hierarchy.
    explicit FibreTracer(const FibreAssembly& assembly, const StopSignal& stopped = {});
    ~FibreTracer();
    FibreTracer(FibreTracer&&) noexcept;

    /// The memory that a tracer takes while it is made, at most [bytes], for so many segments in a
    /// cell and thickness of the same unit.
    static double memory(double segments, const glm::dvec2& cell, double thickness);

    /// What becomes of a ray that travels outside all fibres.
    enum class Flight : uint8_t {
        enters, ///< it meets a fibre
        leaves, ///< it leaves the cloth through z_min or z_max
        lost,   ///< undecided: (nearly) horizontal, it met nothing over kMaxWraps periods; or the
                ///< ray is not finite
    };
    static constexpr int kMaxWraps = 1000;

    struct Entry {
        Flight flight;
        /// The origin already lay inside this fibre (fibres overlap): the point is where the ray,
        /// prolonged backwards, meets its surface — the paper's shift rule (section 4).
        bool overlap;
        FibrePoint point; ///< where it enters, if it does
    };
    /// Where a ray outside all fibres first enters one. `leaving` is the segment on whose surface
    /// the ray starts, in the period it is stored in (kNone: it starts in free space): that very
    /// cylinder is convex and cannot be met again, and only then is the origin tested for lying
    /// inside another fibre.
    static constexpr uint32_t kNone = ~0u;
    Entry enter(const glm::dvec3& origin, const glm::dvec3& direction, uint32_t leaving) const;

    /// Where a ray inside the fibre of `segment`, starting in or on it, reaches the fibre's
    /// surface, walking from cylinder to cylinder along the chain. No accelerator is asked. A ray
    /// that runs parallel to a straight fibre's axis never does: it stops after kMaxSteps
    /// cylinders, where it then is.
    static constexpr int kMaxSteps = 10000;
    FibrePoint leave(const glm::dvec3& origin, const glm::dvec3& direction, uint32_t segment) const;

    glm::dvec2 cell() const;
    double z_min() const; ///< of all surfaces
    double z_max() const;
    std::span<const FibreSegment> segments() const;

  private:
    struct Implementation;
    std::unique_ptr<Implementation> implementation_;
};

} // namespace rapport::kernel
