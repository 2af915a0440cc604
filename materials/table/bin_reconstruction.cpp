#include "materials/table/bin_reconstruction.h"

#include <algorithm>
#include <cmath>

namespace rapport {
namespace {

/// Mean θ over the solid angle of a ring.
double mean_theta(const DirectionMesh& mesh, int ring) {
    const auto integral = [](double theta) { return std::sin(theta) - theta * std::cos(theta); };
    const double low = mesh.theta_low(ring), high = mesh.theta_low(ring + 1);
    return (integral(high) - integral(low)) / (std::cos(low) - std::cos(high));
}

/// The means of a ring at azimuth φ (in turns), linear between the centres of its bins.
Rgb ring_at(const DirectionMesh& mesh, std::span<const Rgb> means, int ring, double turns) {
    const auto count = static_cast<double>(mesh.ring_bins(ring));
    const double x = (turns - std::floor(turns)) * count - 0.5;
    const double below = std::floor(x);
    const size_t first = mesh.ring_first(ring), bins = mesh.ring_bins(ring);
    const size_t i = (static_cast<size_t>(below + count)) % bins;
    return glm::mix(means[first + i], means[first + (i + 1) % bins], static_cast<float>(x - below));
}

/// A direction across rings: its mean intensity, and its signed angle from the pole.
struct Neighbour {
    Rgb mean;
    double theta;
};

Neighbour inner_neighbour(const DirectionMesh& mesh, std::span<const Rgb> means, int ring,
                          double turns) {
    if (ring == 0) // the bin across the pole
        return {ring_at(mesh, means, 0, turns + 0.5), -mean_theta(mesh, 0)};
    return {ring_at(mesh, means, ring - 1, turns), mean_theta(mesh, ring - 1)};
}

Neighbour outer_neighbour(const DirectionMesh& mesh, std::span<const Rgb> means, int ring,
                          double turns) {
    const int outer = std::min(ring + 1, mesh.rings() - 1); // the horizon has a one-sided slope
    return {ring_at(mesh, means, outer, turns), mean_theta(mesh, outer)};
}

void keep_positive(BinPlane& plane) {
    constexpr float kSteepest = 0.999f; // at 1 rounding would decide whether a corner scatters
    for (int channel = 0; channel < 3; ++channel) {
        const float steepest =
            std::abs(plane.slope_xi[channel]) + std::abs(plane.slope_eta[channel]);
        const float allowed = kSteepest * plane.mean[channel];
        if (steepest > allowed) {
            plane.slope_xi[channel] *= allowed / steepest;
            plane.slope_eta[channel] *= allowed / steepest;
        }
    }
}

} // namespace

std::vector<BinPlane> reconstruct(const DirectionMesh& mesh, std::span<const Rgb> means) {
    std::vector<BinPlane> planes;
    planes.reserve(means.size());
    for (int ring = 0; ring < mesh.rings(); ++ring) {
        const size_t first = mesh.ring_first(ring), bins = mesh.ring_bins(ring);
        for (size_t i = 0; i < bins; ++i) {
            const double turns = (static_cast<double>(i) + 0.5) / static_cast<double>(bins);
            const Neighbour inner = inner_neighbour(mesh, means, ring, turns);
            const Neighbour outer = outer_neighbour(mesh, means, ring, turns);
            const double half_width = 0.5 * mesh.ring_width();
            const auto scale = static_cast<float>(half_width / (outer.theta - inner.theta));
            const Rgb& left = means[first + (i + bins - 1) % bins];
            const Rgb& right = means[first + (i + 1) % bins];
            planes.push_back(
                {means[first + i], (outer.mean - inner.mean) * scale, (right - left) * 0.25f});
            keep_positive(planes.back());
        }
    }
    return planes;
}

BinLookup::BinLookup(const DirectionMesh& mesh)
    : rings_per_radian_(static_cast<float>(1 / mesh.ring_width())) {
    for (int ring = 0; ring < mesh.rings(); ++ring) {
        const bool last = ring + 1 == mesh.rings();
        const double cos_low = std::cos(mesh.theta_low(ring));
        const double cos_high = last ? 0 : std::cos(mesh.theta_low(ring + 1));
        const size_t bins = mesh.ring_bins(ring);
        rings_.push_back({static_cast<uint32_t>(mesh.ring_first(ring)), static_cast<uint32_t>(bins),
                          static_cast<float>(cos_low), static_cast<float>(cos_high),
                          static_cast<float>(2 / (cos_low - cos_high)),
                          static_cast<float>(static_cast<double>(bins) / (2 * kPi))});
        ring_of_.resize(ring_of_.size() + bins, static_cast<uint8_t>(ring));
    }
}

glm::vec3 BinLookup::direction(const BinPosition& position) const {
    const Ring& r = rings_[ring_of_[position.bin]];
    const float cosine = std::clamp(glm::mix(r.cos_low, r.cos_high, 0.5f * (position.xi + 1)),
                                    kSmallestCosine, 1.0f);
    const float step = static_cast<float>(position.bin - r.first) + 0.5f * (position.eta + 1);
    const float phi = step / r.bins_per_radian;
    const float sine = std::sqrt((1 - cosine) * (1 + cosine));
    return {sine * std::cos(phi), sine * std::sin(phi), cosine};
}

glm::vec2 sample_plane(float a, float b, const glm::vec2& u) {
    // Inverts the distribution of the density (1 + s·x)/2: s·x² + 2x + (2 − s − 4u) = 0, by the
    // form of the root that does not cancel as s → 0.
    const auto sample_slope = [](float s, float u) {
        const float c = 2 - s - 4 * u;
        return std::clamp(-c / (1 + safe_sqrt(1 - s * c)), -1.0f, 1.0f);
    };
    const float xi = sample_slope(a, u.x);
    const float density = std::max(1 + a * xi, 1e-6f);
    return {xi, sample_slope(std::clamp(b / density, -1.0f, 1.0f), u.y)};
}

} // namespace rapport
