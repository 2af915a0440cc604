#pragma once

#include "renderer/scene/mesh/mesh.h"

namespace rapport {

/// Bound on coordinates, which ray tracing in single precision must be able to square.
inline constexpr float kMaxCoordinate = 1e18f;
bool has_far_positions(const TriangleMesh& mesh); ///< any at the bound, beyond it, or not finite

/// Moves a mesh by an affine, invertible map. The face side stays the same side of the cloth, also
/// under a reflection: triangles are turned round so that they still run counter-clockwise.
void transform(TriangleMesh& mesh, const glm::mat4& matrix);

/// Makes the other side the face (pbrt's ReverseOrientation).
void reverse_orientation(TriangleMesh& mesh);

/// Where vertex normals and the order of a triangle's vertices contradict each other, the normals
/// decide which side is the face, as in pbrt.
void orient_by_normals(TriangleMesh& mesh);

/// ∂P/∂v within triangle `index`, from positions and UVs; the zero vector where the UVs span no
/// area.
glm::vec3 triangle_warp(const TriangleMesh& mesh, uint32_t index);

/// The box between two corners, its faces outwards.
TriangleMesh box(const glm::vec3& low, const glm::vec3& high);

} // namespace rapport
