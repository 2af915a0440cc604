#pragma once

#include "renderer/scene/mesh/mesh.h"

namespace rapport {

/// A tangent frame that need not be orthogonal.
struct WeftWarp {
    glm::dvec3 weft, warp;
    /// False where the UV map is singular, so that weft and warp mean nothing.
    bool sound;
};

/// ∂P/∂u and ∂P/∂v from the derivatives along any two parameters s and t, by the chain rule:
/// [P_u P_v] = [P_s P_t]·[U_s U_t]⁻¹. On mirrored UVs, as seen from the side of the unit vector
/// `normal`, weft is reversed: cloth is never mirrored face-out, so (weft, warp, normal) is always
/// right-handed.
WeftWarp weft_warp(const glm::dvec3& position_s, const glm::dvec3& position_t,
                   const glm::dvec2& uv_s, const glm::dvec2& uv_t, const glm::dvec3& normal);

/// The frame of unit vectors whose warp is `warp`, brought into the tangent plane of the unit
/// vector `normal`; not sound if it has no part there.
WeftWarp weft_across(const glm::dvec3& warp, const glm::dvec3& normal);

/// Gives each vertex whose frame is not `sound` that of the nearest sound vertex along the edges of
/// the mesh, turned into its own tangent plane; pieces without any sound vertex take a frame about
/// the normal. Returns how many were mended. The mesh needs normals.
size_t repair_frames(TriangleMesh& mesh, std::vector<char> sound);

/// Whether the UVs of a triangle run clockwise as seen from the face side.
bool has_mirrored_uvs(const IndexedMesh& mesh, size_t triangle);

/// Unit normals per vertex: the sum of the adjacent triangles' normals, weighted by their angles.
/// (0, 0, 1) where no triangle has an area.
std::vector<glm::vec3> smooth_normals(const std::vector<glm::vec3>& positions,
                                      const std::vector<glm::uvec3>& triangles);

/// Fills weft and warp of a mesh that has UVs: per vertex the mean of its triangles' constant
/// derivatives, weighted by area. Returns how many frames were mended.
size_t add_frames(TriangleMesh& mesh);

} // namespace rapport
