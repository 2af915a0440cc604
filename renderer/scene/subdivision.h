#pragma once

#include "renderer/scene/mesh.h"

namespace rapport {

struct SubdivisionReport {
    size_t faces = 0, unrefinable = 0; ///< unrefinable faces keep their flat triangles
    size_t mirrored = 0;               ///< faces whose UVs are mirrored
    size_t frames_repaired = 0;        ///< vertices where the UV derivative was singular
};

/// The Loop limit surface of a triangle mesh (OpenSubdiv Bfr), each face cut into level² triangles
/// (level ≥ 1; level 1 moves the vertices onto the limit surface). Vertices on shared edges are
/// shared, so there are no cracks; UV seams double vertices with equal positions. `weft` and
/// `warp` are the derivatives of the limit surface along u and v; on mirrored UVs weft is reversed
/// so that cloth is never mirrored face-out (warp stays +v). `name` is for FileErrors: a mesh
/// without UVs is one, unless `need_uvs` is false (then weft and warp stay empty).
TriangleMesh subdivide(const IndexedMesh& mesh, int level, bool need_uvs, const std::string& name,
                       SubdivisionReport* report = nullptr);

} // namespace rapport
