#pragma once

#include "renderer/scene/mesh/manifold.h"
#include "renderer/scene/mesh/mesh_cleaning.h"

#include <array>

namespace rapport {

// Sides of triangles are numbered 3 · triangle + corner, for the side from that corner to the next;
// the same number stands for the corner itself.

inline uint32_t next_side(uint32_t side) { return side % 3 == 2 ? side - 2 : side + 1; }

/// A face of the control mesh: a triangle, or a quad made of two.
struct Face {
    std::array<uint32_t, 4> side; ///< its corners and sides in order, in their triangles
    uint32_t size;                ///< 3 or 4

    uint32_t triangle() const { return side[0] / 3; }
};

/// How the limit surface over a face is parametrised (limit_surface.h).
enum class FaceKind { triangle, quad, quartered_triangle /**< of Catmull & Clark's surface */ };

/// What is subdivided: a clean mesh, cut to a manifold, and where its limit surface is not smooth.
struct ControlMesh {
    const IndexedMesh& mesh;
    ManifoldMesh cut;
    std::vector<char> detached;   ///< per triangle: stays flat, cut off from the others
    std::vector<EdgeUse> edges{}; ///< edge_uses(cut.triangles)
    std::vector<char> crease{};   ///< per side, the same on both sides of an edge
    /// Per corner: corners of a vertex with the same number share a normal.
    std::vector<uint32_t> smooth_group{};
    std::vector<Face> faces{}; ///< all triangles, in order
    size_t t_junctions = 0;    ///< vertices (t_junctions.h)
    bool has_quads = false;    ///< then it is Catmull & Clark's surface, else Loop's

    uint32_t vertex(uint32_t side) const {
        return cut.triangles[side / 3][static_cast<int>(side % 3)];
    }
    FaceKind kind(const Face& face) const {
        if (face.size == 4)
            return FaceKind::quad;
        return !has_quads || detached[face.triangle()] ? FaceKind::triangle
                                                       : FaceKind::quartered_triangle;
    }
    glm::dvec3 position(uint32_t side) const {
        return mesh.positions[mesh.position_index[side / 3][static_cast<int>(side % 3)]];
    }
    uint32_t uv(uint32_t side) const { return number(mesh.uv_index, side); }
    uint32_t color(uint32_t side) const { return number(mesh.color_index, side); }

  private:
    static uint32_t number(const std::vector<glm::uvec3>& index, uint32_t side) {
        return index.empty() ? 0 : index[side / 3][static_cast<int>(side % 3)];
    }
};

struct ControlMeshOptions {
    /// An edge is a crease where the file's normals on its two sides differ by more, at either end
    /// [rad]. Without normals there are none.
    double crease_angle;
    /// Joins triangles that follow each other in the file and make a convex quad without a seam or
    /// crease on its diagonal: what was a quad before it was exported.
    bool quads;
};

/// The mesh, which must be clean and outlive the result.
ControlMesh make_control_mesh(const IndexedMesh& mesh, const std::vector<char>& detached,
                              const ControlMeshOptions& options);

} // namespace rapport
