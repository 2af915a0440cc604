#pragma once

#include "renderer/scene/manifold.h"

#include <memory>
#include <span>

namespace rapport {

/// A point of a surface over the parameters (s, t) of one triangle: corner 0 is at (0, 0), corner 1
/// at (1, 0), corner 2 at (0, 1). `uv` and its derivatives are 0 for a surface without UVs.
struct LimitPoint {
    glm::dvec3 position, position_s, position_t;
    glm::dvec2 uv, uv_s, uv_t;
};

/// The Loop limit surface of the attached triangles of a cut mesh, by OpenSubdiv's Bfr: position
/// and UV with their exact first derivatives. Borders are smooth cubic B-splines with sharp
/// corners where a triangle stands alone (EDGE_AND_CORNER); pinned vertices and straight sides are
/// sharp. UVs go through the same limit rules as the positions, on both sides of a seam
/// (local_uvs.h). Immutable and safe to share between threads; the mesh and its cut must outlive
/// it.
class LimitSurface {
  public:
    LimitSurface(const ManifoldMesh& cut, const std::vector<char>& detached,
                 const IndexedMesh& mesh);
    ~LimitSurface();

    /// Evaluates points of one attached triangle; false if it has no limit surface.
    bool evaluate(uint32_t triangle, std::span<const glm::dvec2> parameters,
                  std::span<LimitPoint> points) const;

  private:
    struct Implementation;
    std::unique_ptr<const Implementation> implementation_;
};

/// The same for a flat triangle.
LimitPoint flat_point(const IndexedMesh& mesh, uint32_t triangle, const glm::dvec2& parameter);

} // namespace rapport
