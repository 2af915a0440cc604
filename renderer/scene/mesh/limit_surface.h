#pragma once

#include "renderer/scene/mesh/control_mesh.h"

#include <memory>
#include <span>

namespace rapport {

/// A point of a surface over the parameters (s, t) of one face. In a triangle, corner 0 is at (0,
/// 0), corner 1 at (1, 0), corner 2 at (0, 1); in a quad, they go round the unit square from (0,
/// 0); triangles of Catmull & Clark's surface are parametrised in quarters, as Bfr does. `uv` and
/// its derivatives are 0 for a surface without UVs.
struct LimitPoint {
    glm::dvec3 position, position_s, position_t;
    glm::dvec2 uv, uv_s, uv_t;
};

/// The limit surface of the attached faces of a control mesh, Loop's or, if it has quads, Catmull &
/// Clark's, by OpenSubdiv's Bfr: position and UV with their exact first derivatives. Borders are
/// smooth cubic B-splines with sharp corners where a face stands alone (EDGE_AND_CORNER); pinned
/// vertices, straight sides and creases are sharp. UVs go through the same limit rules as the
/// positions, on both sides of a seam (local_uvs.h). Immutable and safe to share between threads;
/// the control mesh must outlive it.
class LimitSurface {
  public:
    explicit LimitSurface(const ControlMesh& control);
    ~LimitSurface();

    /// Evaluates points of one attached face; false if it has no limit surface.
    bool evaluate(uint32_t face, std::span<const glm::vec2> parameters,
                  std::span<LimitPoint> points) const;

  private:
    struct Implementation;
    std::unique_ptr<const Implementation> implementation_;
};

/// The same for a flat triangle.
LimitPoint flat_point(const IndexedMesh& mesh, uint32_t triangle, const glm::vec2& at);

} // namespace rapport
