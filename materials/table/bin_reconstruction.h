#pragma once

#include "materials/table/direction_mesh.h"
#include "materials/table/fast_angles.h"
#include "materials/table/highlight_shift.h"
#include "renderer/core/bands.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace rapport {

/// A place inside a bin: ξ runs from −1 at the edge next to the pole to 1, linear in cosθ; η from
/// −1 to 1 along φ. Equal areas of (ξ, η) are equal solid angles.
struct BinPosition {
    uint32_t bin;
    float xi, eta;
};

/// Intensity inside a bin, a plane over its (ξ, η): the bin's mean is kept whatever the slopes.
struct BinPlane {
    Rgb mean, slope_xi, slope_eta;

    Rgb at(const BinPosition& p) const { return mean + slope_xi * p.xi + slope_eta * p.eta; }
};

/// Second-order reconstruction of intensity [1/sr] from the bin means over one hemisphere, as in
/// finite-volume schemes (van Leer 1979): the slope of each bin is the central difference of its
/// neighbours' means, scaled down where the plane would fall below 0 in a corner. Between bins of a
/// smooth lobe that leaves steps of third order in their width; slopes limited to keep extrema
/// (minmod) would flatten every highlight into its bin. Means must be ≥ 0.
std::vector<BinPlane> reconstruct(const DirectionMesh& mesh, std::span<const Rgb> means);

/// Least |cosθ| of a direction that is sampled: on the horizon it would lose its side.
inline constexpr float kSmallestCosine = 1e-7f;

/// A DirectionMesh laid out for single-precision look-up, both ways.
class BinLookup {
  public:
    explicit BinLookup(const DirectionMesh& mesh);

    /// Where the unit vector `w` lies, on its own hemisphere.
    BinPosition locate(const glm::vec3& w) const;
    /// Of four unit vectors.
    std::array<BinPosition, 4> locate(const Direction<Float4>& w) const;
    /// The unit vector, on the hemisphere of +z; its z is never quite 0.
    glm::vec3 direction(const BinPosition& position) const;

  private:
    struct Ring {
        uint32_t first, bins;
        float cos_low, cos_high; ///< at the edge next to the pole, and at the other
        float xi_per_cosine, bins_per_radian;
    };
    /// At `cosine` in [0, 1] to the pole, θ = acos of it.
    BinPosition place(float cosine, float theta, float phi) const;

    std::vector<Ring> rings_;
    std::vector<uint8_t> ring_of_;
    float rings_per_radian_;
};

RAPPORT_INLINE BinPosition BinLookup::place(float cosine, float theta, float phi) const {
    const auto last = static_cast<int>(rings_.size()) - 1;
    const Ring& r = rings_[std::min(static_cast<int>(theta * rings_per_radian_), last)];
    const float xi = (r.cos_low - cosine) * r.xi_per_cosine - 1;
    const float x = phi * r.bins_per_radian;
    const auto step = std::min(static_cast<int>(x), static_cast<int>(r.bins) - 1);
    const float eta = 2 * (x - static_cast<float>(step)) - 1;
    return {r.first + static_cast<uint32_t>(step), std::clamp(xi, -1.0f, 1.0f),
            std::clamp(eta, -1.0f, 1.0f)};
}

inline BinPosition BinLookup::locate(const glm::vec3& w) const {
    const float cosine = std::min(std::abs(w.z), 1.0f);
    return place(cosine, fast_acos(cosine), fast_azimuth(w.x, w.y));
}

RAPPORT_INLINE std::array<BinPosition, 4> BinLookup::locate(const Direction<Float4>& w) const {
    const Float4 cosine = min(abs(w.z), Float4(1.0f));
    const Float4 theta = fast_acos(cosine), phi = fast_azimuth(w.x, w.y);
    std::array<BinPosition, 4> places;
    for (int i = 0; i < 4; ++i)
        places[i] = place(cosine[i], theta[i], phi[i]);
    return places;
}

/// Draws (ξ, η) in [−1, 1]² with density ∝ 1 + a·ξ + b·η from uniform `u`, where |a| + |b| ≤ 1.
glm::vec2 sample_plane(float a, float b, const glm::vec2& u);

} // namespace rapport
