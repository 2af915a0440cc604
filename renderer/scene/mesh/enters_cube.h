#pragma once

#include "renderer/scene/mesh/mesh.h"

namespace rapport {

/// Whether any triangle has a point within the open cube (-1, 1)³, into which the affine map
/// `to_cube` brings world space.
bool enters_cube(const TriangleMesh& mesh, const glm::dmat4& to_cube);

} // namespace rapport
