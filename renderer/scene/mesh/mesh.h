#pragma once

#include "renderer/core/math.h"

#include <array>
#include <cstdint>
#include <string>
#include <vector>

namespace rapport {

/// A polygon-free, ready-to-trace triangle mesh in world space. Per-vertex arrays other than
/// positions are empty or as long as positions.
struct TriangleMesh {
    std::vector<glm::vec3> positions;
    std::vector<glm::vec3> normals; ///< unit shading normals, face side
    std::vector<glm::vec2> uvs;
    /// ∂P/∂u and ∂P/∂v of the surface, not orthogonalised; with an IndexedMesh's `warps`, unit
    /// vectors.
    std::vector<glm::vec3> weft, warp;
    std::vector<glm::vec4> colors;     ///< linear RGB and alpha, in [0, 1]
    std::vector<glm::uvec3> triangles; ///< counter-clockwise seen from the face side
};

/// A mesh as a file holds it: corners index positions, UVs, normals and colours apart, so that a UV
/// seam does not cut the surface. Indices are valid and coordinates finite.
struct IndexedMesh {
    std::vector<glm::vec3> positions;
    std::vector<glm::vec2> uvs; ///< v upwards
    /// Where the warp runs, if that is not for the UVs to say: empty, or for each UV a vector of
    /// any length.
    std::vector<glm::vec3> warps;
    std::vector<glm::vec3> normals;
    std::vector<glm::vec4> colors;          ///< linear RGB and alpha, in [0, 1]
    std::vector<glm::uvec3> position_index; ///< per triangle
    std::vector<glm::uvec3> uv_index;       ///< per triangle; empty when there are no UVs
    std::vector<glm::uvec3> normal_index;   ///< per triangle; empty when there are no normals
    std::vector<glm::uvec3> color_index;    ///< per triangle; empty when there are no colours

    std::array<std::vector<glm::uvec3>*, 4> indices() {
        return {&position_index, &uv_index, &normal_index, &color_index};
    }
};

} // namespace rapport
