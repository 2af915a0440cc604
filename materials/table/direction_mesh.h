#pragma once

#include "renderer/core/math.h"

#include <vector>

namespace rapport {

/// A mesh of exit directions on one hemisphere: rings of equal Δθ, each cut into equal Δφ so that
/// bins are nearly square; ring 0 touches the pole. Bin numbers run along φ within a ring, then
/// outwards. θ is measured from the pole of the hemisphere the light leaves into, φ from +x
/// towards +y on both sides, bins of a ring start at φ = 0.
///
/// A ring has a multiple of four bins, so that mirroring in a yarn direction or turning by 90° maps
/// bins onto bins. Ring 0 too has four instead of one: across the pole there is a slope to tell.
class DirectionMesh {
  public:
    static constexpr int kMaxRings = 180;
    /// `rings` rings of 90°/rings each; std::invalid_argument outside 1 … kMaxRings.
    explicit DirectionMesh(int rings = 18);

    size_t bins() const { return solid_angle_.size(); }
    int rings() const { return static_cast<int>(first_.size()) - 1; }
    double solid_angle(size_t bin) const { return solid_angle_[bin]; } ///< [sr]
    /// The bin of direction `w` of unit length, |w.z| being the cosine to the pole.
    size_t bin(const glm::dvec3& w) const;
    /// θ beyond [0, π/2] counts as the nearest end; φ may be any angle.
    size_t bin(double theta, double phi) const;
    /// 4·bin + q, q the quarter of the bin that `w` lies in: each bin is cut in two at the middle
    /// of its cosθ and of its φ, so that its quarters have equal solid angles. It is the mesh twice
    /// as fine that keeps the edges of this one.
    size_t quarter(const glm::dvec3& w) const;

    size_t ring_first(int ring) const { return first_[ring]; }
    size_t ring_bins(int ring) const { return first_[ring + 1] - first_[ring]; }
    int ring_of(size_t bin) const;
    double theta_low(int ring) const { return ring * ring_width_; }
    double ring_width() const { return ring_width_; }
    struct Bounds {
        double theta_low, theta_high, phi_low, phi_high;
    };
    Bounds bounds(size_t bin) const;

    bool operator==(const DirectionMesh&) const = default;

  private:
    struct Place {
        int ring;
        double step; ///< [0, bins of the ring): the bin and how far along φ in it
    };
    Place place(double theta, double phi) const;

    double ring_width_;
    std::vector<size_t> first_; ///< rings + 1
    std::vector<double> solid_angle_;
};

} // namespace rapport
