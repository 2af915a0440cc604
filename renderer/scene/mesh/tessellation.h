#pragma once

#include "renderer/scene/mesh/control_mesh.h"

#include <functional>
#include <limits>
#include <optional>

namespace rapport {

/// How the faces of a control mesh, cut into small triangles, share their vertices: those on a
/// common side are one, but where the UVs or colours differ on the two sides of a seam, or the
/// normals on the two sides of a crease, there is one for each.
struct Tessellation {
    static constexpr uint32_t kInside = std::numeric_limits<uint32_t>::max();
    struct Vertex {
        uint32_t face = 0;       ///< the first that has it, and evaluates it
        uint32_t place = 0;      ///< the vertex whose position it has, itself for the first of them
        uint32_t normal = 0;     ///< the vertex whose normal it has
        uint32_t side = kInside; ///< of the face, if it lies on one
        uint16_t step = 0, rate = 1; ///< it lies step/rate along that side; step 0 is the corner
        glm::vec2 parameter{0};      ///< in the face's limit surface
    };
    std::vector<Vertex> vertices;         ///< those of one face together, faces in order
    std::vector<uint32_t> first;          ///< per face: its first vertex; and the end
    std::vector<glm::uvec3> triangles;    ///< faces in order
    std::vector<uint32_t> first_triangle; ///< per face; and the end
};

inline constexpr int kMaxRate = std::numeric_limits<uint16_t>::max();

/// How many pieces the edge between two positions is cut into, from 1 to kMaxRate. Called with the
/// positions in one order for all faces on the edge.
using EdgeRate = std::function<int(const glm::dvec3&, const glm::dvec3&)>;

/// Per side of the control mesh: how many pieces its edge is cut into.
using SideRates = std::vector<uint16_t>;
SideRates side_rates(const ControlMesh& control, const EdgeRate& rate);
/// The same for one edge.
uint16_t pieces_of(const ControlMesh& control, std::span<const EdgeUse> edge, const EdgeRate& rate);

/// Nothing if it took more than `max_triangles`.
std::optional<Tessellation> tessellate(const ControlMesh& control, const SideRates& rates,
                                       size_t max_triangles);

} // namespace rapport
