#pragma once

#include "renderer/core/stop_signal.h"
#include "renderer/kernel/fibres.h"

#include <memory>
#include <optional>

namespace rapport::kernel {

/// A displacement by whole periods along x and y.
struct Shift {
    int16_t x = 0, y = 0;
    bool operator==(const Shift&) const = default;
};

/// The part of an endless assembly that rays are traced in: the base cell [0, cell.x) ×
/// [0, cell.y) and a margin about it, filled with every copy of every segment that reaches into
/// it, in an Embree scene of user geometry.
///
/// Embree works in single precision on padded bounds. The callback's own single precision decides
/// which cylinder is hit; every decision within rounding of the ray's origin is made in double
/// precision, so that neighbouring fibres may touch.
class FibreBlock {
  public:
    FibreBlock(const FibreAssembly& assembly, const StopSignal& stopped);
    ~FibreBlock();

    /// What a block takes while it is made, at most [bytes].
    static double memory(double segments, const glm::dvec2& cell, double thickness);

    struct Ray {
        glm::dvec3 origin, direction; ///< origin in the base cell, above or below it
        double reach;                 ///< greatest distance to look
        uint32_t leaving;             ///< segment that is never hit, in the period `leaving_shift`
        Shift leaving_shift;
        bool test_overlap; ///< whether the origin lies inside another fibre than that of `leaving`
    };
    struct Found {
        uint32_t segment;
        Shift shift;
        bool around; ///< the origin lies inside it; else the ray enters it
    };
    std::optional<Found> find(const Ray& ray) const;

    /// Moves `origin` into the base cell; returns by how many periods it was moved.
    Shift wrap(glm::dvec3& origin) const;
    /// Distance from an origin in the base cell to where the ray leaves the block sideways.
    double distance_to_side(const glm::dvec3& origin, const glm::dvec3& direction) const;

    glm::dvec3 offset(Shift shift) const { return {shift.x * cell().x, shift.y * cell().y, 0}; }
    const glm::dvec2& cell() const { return cell_; }
    const std::vector<FibreSegment>& segments() const { return segments_; }
    /// Along the chain of `segment`.
    const glm::dvec3& period(const FibreSegment& segment) const { return periods_[segment.chain]; }
    double z_min() const { return z_min_; }
    double z_max() const { return z_max_; }
    /// Bound on single precision's error of a length within the block.
    double tolerance() const { return tolerance_; }

  private:
    struct Copy;
    struct Embree;
    friend struct Callbacks;

    void measure_extent(const StopSignal& stopped);
    template <class Visit> void each_copy(const StopSignal& stopped, Visit visit) const;
    void fill(const StopSignal& stopped);
    bool same_fibre(uint32_t segment_a, Shift a, uint32_t segment_b, Shift b) const;

    glm::dvec2 cell_;
    std::vector<FibreSegment> segments_;
    std::vector<glm::dvec3> periods_; ///< of the chains
    std::vector<Shift> chain_period_; ///< the same in cells
    std::vector<Copy> copies_;
    double margin_ = 0;
    double z_min_ = 0, z_max_ = 0;
    double tolerance_ = 0;
    std::unique_ptr<Embree> embree_;
};

} // namespace rapport::kernel
