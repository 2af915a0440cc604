#pragma once

#include "renderer/scene/mesh/mesh.h"

namespace rapport {

/// How many of the triangles have a point within the open cube (-1, 1)³, into which the affine map
/// `to_cube` brings world space.
size_t triangles_inside(const TriangleMesh& mesh, const glm::dmat4& to_cube);

} // namespace rapport
