#pragma once

#include "renderer/scene/mesh/mesh.h"

namespace rapport {

/// A triangle mesh cut open wherever it is no oriented surface, so that what is left is a manifold
/// with border: along edges with more than two triangles or with two that run the same way, and at
/// vertices where several fans of triangles meet in a point (Guéziec, Taubin, Lazarus & Horn 1998,
/// "Converting Sets of Polygons to Manifold Surfaces by Cutting and Stitching").
struct ManifoldMesh {
    std::vector<glm::uvec3> triangles;
    std::vector<uint32_t> origin; ///< per vertex: the vertex of the uncut mesh
    /// Per vertex: lies on a cut. A limit surface that is sharp in pinned vertices passes through
    /// them, so that the pieces still meet there.
    std::vector<char> pinned;
    /// Per triangle and side: lies on a cut. Between sharp ends the limit curve of a border is the
    /// straight segment, the same for all pieces.
    std::vector<glm::bvec3> straight;
    /// Vertices of detached triangles come after all others.
    uint32_t attached_vertices = 0;
    size_t non_manifold_edges = 0;
    size_t bow_ties = 0; ///< vertices where fans meet that no such edge cut apart
};

/// Triangles named in `detached` are cut off on all sides, too. The triangles must be clean: three
/// different vertices each, none twice.
ManifoldMesh cut_to_manifold(const std::vector<glm::uvec3>& triangles,
                             const std::vector<char>& detached);

} // namespace rapport
