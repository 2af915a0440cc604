#pragma once

#include "renderer/core/fresnel.h"
#include "renderer/core/rng.h"
#include "tests/support/stability.h"

#include <algorithm>
#include <glm/glm.hpp>
#include <optional>
#include <vector>

namespace rapport::tests {

/// How much light the rule for overlaps may send elsewhere than fibres grown together.
inline double overlap_error(double overlap) { return 0.35 * std::max(0.0, overlap); }

/// Light in the plane across straight, parallel fibres, where what the fibres cover together is
/// one body of glass: what overlapping fibres would be if they had grown together. Independent of
/// the tracer: every disk of many periods is asked, in double precision.
class UnionOfDisks {
  public:
    /// `absorption` in 1/µm.
    explicit UnionOfDisks(ParallelFibres fibres, double index = 1.53, double absorption = 0)
        : fibres_(std::move(fibres)), index_(index), absorption_(absorption) {
        for (const glm::dvec2& centre : fibres_.centres)
            top_ = std::max(top_, std::abs(centre.y) + fibres_.radius);
    }

    /// Of light from `theta` (towards +x from +z).
    Shares shares(double theta, uint64_t paths) const {
        double reflected = 0, transmitted = 0, unscattered = 0;
        for (uint64_t k = 0; k < paths; ++k) {
            CounterRng rng(5, Purpose::test, 0, k);
            const glm::dvec2 start(rng.uniform() * fibres_.period, top_);
            const Path path = trace(start, {-std::sin(theta), -std::cos(theta)}, rng);
            double& share = !path.scattered        ? unscattered
                            : path.direction.y > 0 ? reflected
                                                   : transmitted;
            share += path.weight / static_cast<double>(paths);
        }
        const double absorbed = std::max(0.0, 1 - reflected - transmitted - unscattered);
        return {reflected, transmitted, unscattered, absorbed, 0, static_cast<double>(paths), {}};
    }

  private:
    static constexpr double kStep = 1e-9;
    static constexpr double kFar = 1e6; ///< light that goes further along the cloth has left

    struct Path {
        glm::dvec2 direction;
        double weight = 1;
        bool scattered = false;
    };
    struct Crossing {
        double entry, exit;
    };
    std::optional<Crossing> cross(const glm::dvec2& centre, const glm::dvec2& origin,
                                  const glm::dvec2& direction) const {
        const glm::dvec2 to_centre = centre - origin;
        const double middle = glm::dot(to_centre, direction);
        const double chord2 =
            square(fibres_.radius) - glm::dot(to_centre, to_centre) + middle * middle;
        if (chord2 <= 0)
            return std::nullopt;
        return Crossing{middle - std::sqrt(chord2), middle + std::sqrt(chord2)};
    }
    /// All that a ray may cross before it has left the fibres' layer.
    template <class F>
    void each_disk(const glm::dvec2& origin, const glm::dvec2& direction, const F& visit) const {
        const double height = direction.y > 0 ? top_ - origin.y : top_ + origin.y;
        const double reach =
            std::min(kFar, std::max(0.0, height) * std::abs(direction.x / direction.y));
        const double end = origin.x + std::copysign(reach, direction.x);
        const double period = fibres_.period;
        const auto first = static_cast<int>(std::floor(std::min(origin.x, end) / period)) - 1;
        const auto last = static_cast<int>(std::floor(std::max(origin.x, end) / period)) + 1;
        for (int copy = first; copy <= last; ++copy)
            for (const glm::dvec2& centre : fibres_.centres)
                visit(centre + glm::dvec2(copy * period, 0));
    }

    Path trace(glm::dvec2 origin, const glm::dvec2& from, CounterRng& rng) const {
        Path path{from};
        glm::dvec2& direction = path.direction;
        bool inside = false;
        for (;;) {
            origin.x -= std::floor(origin.x / fibres_.period) * fibres_.period;
            double distance = inside ? 0 : 1e30;
            glm::dvec2 centre{};
            bool met = false;
            if (!inside) {
                each_disk(origin, direction, [&](const glm::dvec2& disk) {
                    const auto crossing = cross(disk, origin, direction);
                    if (crossing && crossing->entry > kStep && crossing->entry < distance) {
                        distance = crossing->entry;
                        centre = disk;
                        met = true;
                    }
                });
                if (!met)
                    return path;
                path.scattered = true;
            } else { // from disk to disk, as long as one of them holds the light
                do {
                    met = false;
                    each_disk(origin, direction, [&](const glm::dvec2& disk) {
                        const auto crossing = cross(disk, origin, direction);
                        if (crossing && crossing->entry <= distance + kStep &&
                            crossing->exit > distance + kStep) {
                            distance = crossing->exit;
                            centre = disk;
                            met = true;
                        }
                    });
                } while (met);
                path.weight *= std::exp(-absorption_ * distance);
                if (path.weight == 0)
                    return path;
            }
            origin += direction * distance;
            const glm::dvec2 normal = glm::normalize(origin - centre);
            const glm::dvec2 facing = inside ? -normal : normal;
            const double eta = inside ? index_ : 1 / index_;
            const double cosine = -glm::dot(direction, facing);
            const FresnelResult fresnel = fresnel_dielectric(std::clamp(cosine, 0.0, 1.0), eta);
            if (rng.uniform() < fresnel.reflectance) {
                direction = glm::normalize(direction + facing * (2 * cosine));
            } else {
                direction = glm::normalize(direction * eta +
                                           facing * (eta * cosine - fresnel.cos_transmitted));
                inside = !inside;
            }
        }
    }

    ParallelFibres fibres_;
    double index_, absorption_, top_ = 0;
};

} // namespace rapport::tests
