#pragma once

#include "renderer/core/fresnel.h"
#include "renderer/core/rng.h"

#include <algorithm>
#include <glm/glm.hpp>
#include <optional>
#include <vector>

namespace rapport::tests {

/// Light in the plane across straight, parallel, clear fibres that repeat along x, where what the
/// fibres cover together is one body of glass: what overlapping fibres would be if they had grown
/// together. Independent of the tracer: every disk of many periods is asked, in double precision.
class UnionOfDisks {
  public:
    UnionOfDisks(std::vector<glm::dvec2> centres, double radius, double period, double index)
        : centres_(std::move(centres)), radius_(radius), period_(period), index_(index) {}

    /// Share of light from `theta` (towards +x from +z) that is scattered back to z > 0.
    double reflectance(double theta, int paths) const {
        int reflected = 0;
        for (int k = 0; k < paths; ++k) {
            CounterRng rng(5, Purpose::test, 0, k);
            const double top = 4 * radius_;
            const glm::dvec2 start(rng.uniform() * period_, top);
            reflected += trace(start, {-std::sin(theta), -std::cos(theta)}, rng).y > 0;
        }
        return static_cast<double>(reflected) / paths;
    }

  private:
    static constexpr int kPeriods = 40; ///< to each side; light that goes further has left
    static constexpr double kStep = 1e-9;

    struct Crossing {
        double entry, exit;
    };
    std::optional<Crossing> cross(const glm::dvec2& centre, const glm::dvec2& origin,
                                  const glm::dvec2& direction) const {
        const glm::dvec2 to_centre = centre - origin;
        const double middle = glm::dot(to_centre, direction);
        const double chord2 = radius_ * radius_ - glm::dot(to_centre, to_centre) + middle * middle;
        if (chord2 <= 0)
            return std::nullopt;
        return Crossing{middle - std::sqrt(chord2), middle + std::sqrt(chord2)};
    }
    template <class F> void each_disk(const F& visit) const {
        for (int period = -kPeriods; period <= kPeriods; ++period)
            for (const glm::dvec2& centre : centres_)
                visit(centre + glm::dvec2(period * period_, 0));
    }

    /// The direction in which the path leaves.
    glm::dvec2 trace(glm::dvec2 origin, glm::dvec2 direction, CounterRng& rng) const {
        bool inside = false;
        for (;;) {
            origin.x -= std::floor(origin.x / period_) * period_;
            double distance = inside ? 0 : 1e30;
            glm::dvec2 centre{};
            bool met = false;
            if (!inside) {
                each_disk([&](const glm::dvec2& disk) {
                    const auto crossing = cross(disk, origin, direction);
                    if (crossing && crossing->entry > kStep && crossing->entry < distance) {
                        distance = crossing->entry;
                        centre = disk;
                        met = true;
                    }
                });
                if (!met)
                    return direction;
            } else { // from disk to disk, as long as one of them holds the light
                do {
                    met = false;
                    each_disk([&](const glm::dvec2& disk) {
                        const auto crossing = cross(disk, origin, direction);
                        if (crossing && crossing->entry <= distance + kStep &&
                            crossing->exit > distance + kStep) {
                            distance = crossing->exit;
                            centre = disk;
                            met = true;
                        }
                    });
                } while (met);
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

    std::vector<glm::dvec2> centres_;
    double radius_, period_, index_;
};

} // namespace rapport::tests
