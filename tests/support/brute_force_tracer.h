#pragma once

#include "renderer/kernel/fibres.h"

#include <cmath>
#include <limits>
#include <optional>

namespace rapport::tests {

/// Traces rays among periodic fibres by trying every cylinder in every period that the ray can
/// reach: slow, in double precision, and sharing nothing with the tracer but fibre_segments.
class BruteForceTracer {
  public:
    explicit BruteForceTracer(const kernel::FibreAssembly& assembly)
        : assembly_(assembly), segments_(kernel::fibre_segments(assembly)) {}

    struct Hit {
        double distance = std::numeric_limits<double>::infinity();
        uint32_t segment = 0;
        glm::dvec3 position{}; ///< in the ray's period
    };

    /// The first surface that is entered within `reach`; the segment `leaving` of the ray's own
    /// period is not tried.
    std::optional<Hit> enter(const glm::dvec3& origin, const glm::dvec3& direction, double reach,
                             uint32_t leaving) const {
        Hit nearest;
        for_each_copy(origin, origin + direction * reach,
                      [&](uint32_t number, const glm::dvec3& offset, bool home) {
                          if (number == leaving && home)
                              return;
                          const kernel::FibreSegment& s = segments_[number];
                          const glm::dvec3 o = origin - offset - s.start;
                          const glm::dvec3 m = glm::cross(o, s.direction);
                          const glm::dvec3 n = glm::cross(direction, s.direction);
                          const double a = glm::dot(n, n), b = glm::dot(m, n);
                          const double c = glm::dot(m, m) - s.radius * s.radius;
                          const double discriminant = b * b - a * c;
                          if (a == 0 || discriminant <= 0)
                              return;
                          const double t = (-b - std::sqrt(discriminant)) / a;
                          if (t >= 0 && t < nearest.distance && t <= reach &&
                              between_planes(s, o + direction * t))
                              nearest = {t, number, origin + direction * t};
                      });
        if (std::isinf(nearest.distance))
            return std::nullopt;
        return nearest;
    }

    /// Whether a point lies inside a fibre; fibres of chain `except` are not tried.
    bool inside(const glm::dvec3& point, uint32_t except = ~0u) const {
        bool found = false;
        for_each_copy(point, point, [&](uint32_t number, const glm::dvec3& offset, bool) {
            const kernel::FibreSegment& s = segments_[number];
            const glm::dvec3 o = point - offset - s.start;
            found =
                found || (s.chain != except && glm::length(glm::cross(o, s.direction)) < s.radius &&
                          between_planes(s, o));
        });
        return found;
    }

  private:
    static bool between_planes(const kernel::FibreSegment& s, const glm::dvec3& from_start) {
        return glm::dot(from_start, s.start_normal) >= 0 &&
               glm::dot(from_start, s.end_normal) <= s.end_offset;
    }

    template <class Body>
    void for_each_copy(const glm::dvec3& a, const glm::dvec3& b, const Body& body) const {
        const glm::dvec3 low = glm::min(a, b), high = glm::max(a, b);
        const glm::dvec2 cell = assembly_.cell;
        for (uint32_t number = 0; number < segments_.size(); ++number) {
            const kernel::FibreSegment& s = segments_[number];
            const glm::dvec3 centre = s.start + s.direction * (0.5 * s.length);
            const double size = 0.5 * s.length + 3 * s.radius; // of a ball that holds it
            if (low.z > centre.z + size || high.z < centre.z - size)
                continue;
            for (double y = std::ceil((low.y - size - centre.y) / cell.y);
                 y <= (high.y + size - centre.y) / cell.y; ++y)
                for (double x = std::ceil((low.x - size - centre.x) / cell.x);
                     x <= (high.x + size - centre.x) / cell.x; ++x)
                    body(number, glm::dvec3(x * cell.x, y * cell.y, 0), x == 0 && y == 0);
        }
    }

    kernel::FibreAssembly assembly_;
    std::vector<kernel::FibreSegment> segments_;
};

} // namespace rapport::tests
