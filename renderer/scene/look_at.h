#pragma once

#include <glm/glm.hpp>
#include <optional>

namespace rapport {

/// World to camera. The camera's axes are x = up × direction, y, z = direction (pbrt's). Nothing if
/// the points or directions do not tell.
inline std::optional<glm::dmat4> look_at(const glm::dvec3& eye, const glm::dvec3& target,
                                         const glm::dvec3& up) {
    const glm::dvec3 direction = target - eye, side = glm::cross(up, direction);
    if (!(glm::length(direction) > 0) ||
        !(glm::length(side) > 1e-12 * glm::length(up) * glm::length(direction)))
        return std::nullopt;
    const glm::dvec3 z = glm::normalize(direction), x = glm::normalize(side);
    return glm::inverse(glm::dmat4(glm::dvec4(x, 0), glm::dvec4(glm::cross(z, x), 0),
                                   glm::dvec4(z, 0), glm::dvec4(eye, 1)));
}

} // namespace rapport
