#pragma once

#include "renderer/kernel/scene.h"

namespace rapport {

/// Perspective or orthographic, as in pbrt: the screen window spans [−1, 1] along the shorter side
/// of the film.
struct Camera {
    enum class Kind { perspective, orthographic } kind = Kind::perspective;
    glm::mat4 to_world{1};      ///< camera space: x right, y up, looking along +z
    float fov_degrees = 90;     ///< of the shorter side; perspective only
    glm::vec4 screen_window{0}; ///< x0, x1, y0, y1; all 0 = from the aspect ratio
    glm::ivec2 resolution{1280, 720};

    /// The unit-direction ray through film position `pixel` (continuous, y down).
    kernel::Ray ray(const glm::vec2& pixel) const;
};

} // namespace rapport
