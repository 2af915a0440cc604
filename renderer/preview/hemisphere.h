#pragma once

#include "materials/table/table_bsdf.h"

#include <cstdint>
#include <vector>

namespace rapport {

/// What a cloth does with light from one direction, for the eye.

/// Directions of a hemisphere over a disc: those about the normal in the middle, the horizon at the
/// rim, sinθ outwards (orthographic); weft to the right, warp upwards, for the back as well, as if
/// it were seen through the cloth. Position in [−1, 1]².
glm::vec3 disc_direction(const glm::vec2& position, Side side);

/// The intensity of light from the unit vector `from` (local frame) that leaves on one side of the
/// cloth: a square of RGBA pixels, the disc's brightest at white, in the square root so that the
/// dim shows too; transparent outside.
std::vector<uint8_t> hemisphere_map(const TableBsdf& table, const glm::vec3& from, Side seen,
                                    int size);

/// The same intensity [1/sr], in the mean of R, G and B, over the polar angle from −90° to 90° in
/// the plane of the normal and the weft (or the warp), `count` values.
std::vector<float> intensity_profile(const TableBsdf& table, const glm::vec3& from, Side seen,
                                     bool along_warp, int count);

} // namespace rapport
