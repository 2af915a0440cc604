#pragma once

#include "renderer/scene/mesh/control_mesh.h"

#include <span>

namespace rapport {

/// UVs of the vertices around a face, as one continuous map seen from that face. Vertices
/// that can be reached round its corners without crossing a seam have the UVs written there; those
/// beyond a seam continue the affine map of the face's first triangle. A limit surface through
/// these UVs has the same shape functions as the surface through the positions, so that ∂P/∂u is
/// right up to the seam. (A face-varying surface of OpenSubdiv ends in a border curve there, with
/// other shape functions than the positions, which go on smoothly: its frames turn away near
/// seams.)
class LocalUvs {
  public:
    /// The control mesh has UVs, and must outlive this.
    explicit LocalUvs(const ControlMesh& control);

    /// Writes u and v of each of `vertices` (of the cut mesh, round `face`) to `uvs`.
    void gather(uint32_t face, std::span<const int> vertices, std::span<double> uvs) const;

  private:
    /// Calls `visit` with each triangle that is reached round the corners of a face, together with
    /// the triangles that make quads with them.
    template <class Visit> void for_each_around(const Face& face, const Visit& visit) const;
    glm::dvec2 continued(uint32_t triangle, uint32_t vertex) const;

    const ControlMesh& control_;
    std::vector<uint32_t> across_;       ///< per side: the side of the triangle beyond, if no seam
    std::vector<uint32_t> mate_;         ///< per triangle: the other one of its quad, or itself
    std::vector<uint32_t> uv_of_vertex_; ///< per vertex: its UV if it has but one
};

} // namespace rapport
