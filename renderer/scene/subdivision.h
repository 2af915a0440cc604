#pragma once

#include "renderer/scene/mesh.h"

namespace rapport {

struct SubdivisionReport {
    size_t faces = 0;              ///< triangles of the mesh after cleaning
    size_t dropped = 0;            ///< triangles without area of their own (mesh_cleaning.h)
    size_t non_manifold_edges = 0; ///< cut, and kept straight so that the pieces still meet
    size_t unrefinable = 0;        ///< faces that keep their flat triangles
    size_t mirrored = 0;           ///< faces whose UVs are mirrored
    size_t frames_repaired = 0;    ///< vertices where the UV derivative was singular
};

/// The Loop limit surface of a triangle mesh (OpenSubdiv Bfr), each face cut into level² triangles
/// (1 ≤ level ≤ 65535; level 1 moves the vertices onto the limit surface). Positions are merged by
/// value, so that UV seams do not cut the surface. Vertices on shared edges are shared, so there
/// are no cracks; UV seams double vertices with equal positions and normals. `weft` and `warp` are
/// the derivatives of the limit surface along u and v; on mirrored UVs weft is reversed so that
/// cloth is never mirrored face-out (warp stays +v). `name` is for FileErrors: a mesh without UVs,
/// or whose UVs cover no area at all, is one, unless `need_uvs` is false (then, without UVs, weft
/// and warp stay empty).
TriangleMesh subdivide(const IndexedMesh& mesh, int level, bool need_uvs, const std::string& name,
                       SubdivisionReport* report = nullptr);

/// The mesh as it is, not subdivided: one vertex for each combination of position, UV and normal
/// that occurs. Normals are the file's, on the face side; without them the mean of the triangles
/// around the position. With UVs, weft and warp from the triangles' constant derivatives.
TriangleMesh flat_mesh(const IndexedMesh& mesh);

} // namespace rapport
