#pragma once

#include "renderer/kernel/fibres.h"

#include <memory>
#include <optional>
#include <span>

namespace rapport::kernel {

/// A point on a fibre's surface. Because everything repeats, the position is given in the period
/// in which segment `segment` is stored.
struct FibrePoint {
    glm::dvec3 position;
    glm::dvec3 normal; ///< unit, outward
    uint32_t segment;
    double distance; ///< travelled from the ray's origin
};

/// Traces rays among the fibres of an endless periodic assembly: the narrow door behind which any
/// accelerator may stand. Constant after construction; callable from any thread.
class FibreTracer {
  public:
    explicit FibreTracer(FibreAssembly assembly);
    ~FibreTracer();
    FibreTracer(FibreTracer&&) noexcept;

    struct Entry {
        FibrePoint point;
        /// The origin already lay inside this fibre (fibres overlap): the point is where the ray,
        /// prolonged backwards, meets its surface — the paper's shift rule (section 4).
        bool overlap;
    };
    /// Where a ray outside all fibres first enters one; nothing if it leaves the cloth.
    /// `leaving` is the segment on whose surface the ray starts, in the period it is stored in
    /// (kNone: it starts in free space): that very cylinder is convex and cannot be met again,
    /// and only then is the origin tested for lying inside another fibre.
    static constexpr uint32_t kNone = ~0u;
    std::optional<Entry> enter(const glm::dvec3& origin, const glm::dvec3& direction,
                               uint32_t leaving) const;

    /// Where a ray inside the fibre of `segment`, starting in or on it, reaches the fibre's
    /// surface, walking from cylinder to cylinder along the chain. No accelerator is asked.
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
