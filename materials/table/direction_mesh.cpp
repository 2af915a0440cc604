#include "materials/table/direction_mesh.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

namespace rapport {

DirectionMesh::DirectionMesh(int rings) {
    if (rings < 1 || rings > kMaxRings)
        throw std::invalid_argument("DirectionMesh: rings must be 1 to " +
                                    std::to_string(kMaxRings) + ", not " + std::to_string(rings));
    ring_width_ = kPi / 2 / rings;
    first_.assign(1, 0);
    for (int ring = 0; ring < rings; ++ring) {
        const double circumference = 2 * kPi * std::sin((ring + 0.5) * ring_width_);
        const auto quadrant = std::max<size_t>(1, std::lround(circumference / ring_width_ / 4));
        // 1 - cos differences as a product of sines, which keeps its digits near the pole.
        const double ring_area =
            4 * kPi * std::sin((ring + 0.5) * ring_width_) * std::sin(0.5 * ring_width_);
        first_.push_back(first_.back() + 4 * quadrant);
        solid_angle_.resize(first_.back(), ring_area / (4.0 * quadrant));
    }
}

namespace {

double polar_angle(const glm::dvec3& w) { return std::atan2(std::hypot(w.x, w.y), std::abs(w.z)); }

} // namespace

DirectionMesh::Place DirectionMesh::place(double theta, double phi) const {
    const double outermost = rings() - 1;
    const int ring = static_cast<int>(std::clamp(theta / ring_width_, 0.0, outermost));
    const double turns = phi / (2 * kPi), count = static_cast<double>(ring_bins(ring));
    // A tiny negative angle leaves a fraction that rounds to 1: that is the end of the last bin.
    return {ring, std::min((turns - std::floor(turns)) * count, std::nextafter(count, 0.0))};
}

size_t DirectionMesh::bin(const glm::dvec3& w) const { return bin(polar_angle(w), azimuth(w)); }

size_t DirectionMesh::bin(double theta, double phi) const {
    const Place at = place(theta, phi);
    return first_[at.ring] + static_cast<size_t>(at.step);
}

size_t DirectionMesh::quarter(const glm::dvec3& w) const {
    const Place at = place(polar_angle(w), azimuth(w));
    const double middle = 0.5 * (std::cos(theta_low(at.ring)) + std::cos(theta_low(at.ring + 1)));
    const auto half_step = static_cast<size_t>(2 * at.step);
    return 4 * (first_[at.ring] + half_step / 2) + 2 * (std::abs(w.z) < middle) + half_step % 2;
}

int DirectionMesh::ring_of(size_t bin) const {
    return static_cast<int>(std::upper_bound(first_.begin(), first_.end(), bin) - first_.begin()) -
           1;
}

DirectionMesh::Bounds DirectionMesh::bounds(size_t bin) const {
    const int ring = ring_of(bin);
    const double phi_width = 2 * kPi / static_cast<double>(ring_bins(ring));
    const auto step = static_cast<double>(bin - first_[ring]);
    return {theta_low(ring), theta_low(ring + 1), step * phi_width, (step + 1) * phi_width};
}

} // namespace rapport
