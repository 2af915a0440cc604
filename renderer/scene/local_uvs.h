#pragma once

#include "renderer/scene/manifold.h"

#include <span>

namespace rapport {

/// UVs of the vertices around a triangle, as one continuous map seen from that triangle. Vertices
/// that can be reached round its corners without crossing a seam have the UVs written there; those
/// beyond a seam continue the triangle's own affine map. A limit surface through these UVs has the
/// same shape functions as the surface through the positions, so that ∂P/∂u is right up to the
/// seam. (A face-varying surface of OpenSubdiv ends in a border curve there, with other shape
/// functions than the positions, which go on smoothly: its frames turn away near seams.)
class LocalUvs {
  public:
    /// The mesh, which must outlive this and has UVs, is the one that was cut.
    LocalUvs(const ManifoldMesh& cut, const std::vector<char>& detached, const IndexedMesh& mesh);

    /// Writes u and v of each of `vertices` (of the cut mesh, round `triangle`) to `uvs`.
    void gather(uint32_t triangle, std::span<const int> vertices, std::span<double> uvs) const;

  private:
    /// Calls `visit` with each triangle that is reached round the corners of one.
    template <class Visit> void for_each_around(uint32_t triangle, const Visit& visit) const;
    glm::dvec2 continued(uint32_t triangle, uint32_t vertex) const;

    const ManifoldMesh& cut_;
    const IndexedMesh& mesh_;
    std::vector<uint32_t> across_;       ///< per side: the side of the triangle beyond, if no seam
    std::vector<uint32_t> uv_of_vertex_; ///< per vertex: its UV if it has but one
};

} // namespace rapport
