#pragma once

#include "renderer/scene/mesh/tessellation.h"

#include <string>

namespace rapport {

/// The same number of pieces for every edge: each triangle becomes level² smaller ones.
EdgeRate uniform_rate(int level);

struct SubdivisionOptions {
    EdgeRate rate = uniform_rate(1);
    /// Up to which edges are cut finer where the surface turns sharply (sharp_turns.h); none: not.
    EdgeRate finest_rate = nullptr;
    double crease_angle = kPi; ///< see ControlMeshOptions; π: no creases
    bool quads = false;        ///< see ControlMeshOptions
    bool need_uvs = false;     ///< a mesh without UVs, or whose UVs cover no area, is a FileError
    /// All edges are cut less finely where it would take more; the default is about 8 GB of limit
    /// points, mesh and BVH.
    size_t max_triangles = size_t{1} << 26;
};

struct SubdivisionReport {
    size_t faces = 0;              ///< triangles of the mesh after cleaning
    size_t dropped = 0;            ///< triangles without area of their own (mesh_cleaning.h)
    size_t non_manifold_edges = 0; ///< cut, and kept straight so that the pieces still meet
    size_t bow_ties = 0;           ///< vertices cut apart, where pieces meet in a point
    size_t t_junctions = 0;        ///< vertices on another edge, kept on its straight line
    size_t unrefinable = 0;        ///< faces that keep their flat triangles
    size_t creases = 0;            ///< edges that stay sharp, as the file's normals are there
    size_t quads = 0;              ///< made of two triangles each
    size_t mirrored = 0;           ///< faces whose UVs are mirrored
    size_t frames_repaired = 0;    ///< vertices where the UV derivative was singular
    int coarser = 1;               ///< times that edges are cut less finely than their rates say
};

/// The limit surface of a triangle mesh (limit_surface.h), cut into triangles by the rates of its
/// edges (rate 1 moves the vertices onto the limit surface). Positions are merged by value, so that
/// UV seams do not cut the surface. Vertices on shared edges are shared, so there are no cracks,
/// also between faces that are cut unequally; UV seams double vertices with equal positions and
/// normals, creases those with equal positions. `weft` and `warp` are the derivatives of the limit
/// surface along u and v, and empty without UVs; on mirrored UVs weft is reversed so that cloth is
/// never mirrored face-out (warp stays +v). Where the mesh has warps, these are interpolated over
/// its faces instead, and weft lies across. `name` is for FileErrors.
TriangleMesh subdivide(const CleanMesh& mesh, const SubdivisionOptions& options,
                       const std::string& name, SubdivisionReport* report = nullptr);

/// The mesh as it is, not subdivided: one vertex for each combination of position, UV and normal
/// that occurs. Normals are the file's, on the face side; without them the mean of the triangles
/// around the position. With UVs, weft and warp from the triangles' constant derivatives, or from
/// the mesh's warps. The report tells of mirrored faces and mended frames.
TriangleMesh flat_mesh(const IndexedMesh& mesh, SubdivisionReport* report = nullptr);

} // namespace rapport
