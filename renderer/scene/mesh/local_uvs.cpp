#include "renderer/scene/mesh/local_uvs.h"

#include <algorithm>
#include <limits>

namespace rapport {
namespace {

constexpr uint32_t kNone = std::numeric_limits<uint32_t>::max();
constexpr uint32_t kSeveral = kNone - 1;

} // namespace

LocalUvs::LocalUvs(const ControlMesh& control)
    : control_(control), across_(3 * control.cut.triangles.size(), kNone),
      mate_(control.cut.triangles.size()), uv_of_vertex_(control.cut.origin.size(), kNone) {
    for (uint32_t side = 0; side < across_.size(); ++side) {
        uint32_t& uv = uv_of_vertex_[control.vertex(side)];
        uv = uv == kNone || uv == control.uv(side) ? control.uv(side) : kSeveral;
    }
    for_each_edge(control.edges, [&](std::span<const EdgeUse> edge) {
        if (edge.size() != 2 || control.detached[edge[0].triangle] ||
            control.detached[edge[1].triangle])
            return;
        const uint32_t a = 3 * edge[0].triangle + edge[0].corner;
        const uint32_t b = 3 * edge[1].triangle + edge[1].corner;
        if (control.uv(a) != control.uv(next_side(b)) || control.uv(next_side(a)) != control.uv(b))
            return;
        across_[a] = b;
        across_[b] = a;
    });
    for (const Face& face : control.faces) {
        const uint32_t first = face.side[0] / 3, last = face.side[face.size - 1] / 3;
        mate_[first] = last;
        mate_[last] = first;
    }
}

template <class Visit> void LocalUvs::for_each_around(const Face& face, const Visit& visit) const {
    const auto visit_both = [&](uint32_t triangle) {
        visit(triangle);
        if (mate_[triangle] != triangle)
            visit(mate_[triangle]);
    };
    const uint32_t triangle = face.triangle();
    visit_both(triangle);
    for (uint32_t i = 0; i < face.size; ++i) {
        const uint32_t start = face.side[i];
        for (const bool forward : {true, false}) {
            // Leave by the side after the corner, or by the one before it. The neighbour runs along
            // that side the other way, so there the corner is at its end, or at its beginning.
            uint32_t side = forward ? start : next_side(next_side(start));
            for (uint32_t beyond = across_[side]; beyond != kNone; beyond = across_[side]) {
                if (beyond / 3 == start / 3)
                    break;
                visit_both(beyond / 3);
                side = forward ? next_side(beyond) : next_side(next_side(beyond));
            }
        }
    }
}

void LocalUvs::gather(uint32_t number, std::span<const int> vertices, std::span<double> uvs) const {
    const Face& face = control_.faces[number];
    thread_local std::vector<uint32_t> found; // UV index per entry of `vertices`
    found.clear();
    for (const int vertex : vertices)
        found.push_back(uv_of_vertex_[static_cast<size_t>(vertex)]);
    // One UV for each vertex: then there is no seam between them. Else look who can be reached.
    if (std::find(found.begin(), found.end(), kSeveral) != found.end()) {
        std::fill(found.begin(), found.end(), kNone);
        for_each_around(face, [&](uint32_t t) {
            for (uint32_t corner = 3 * t; corner < 3 * t + 3; ++corner)
                for (size_t i = 0; i < vertices.size(); ++i)
                    if (found[i] == kNone &&
                        static_cast<uint32_t>(vertices[i]) == control_.vertex(corner))
                        found[i] = control_.uv(corner);
        });
    }
    for (size_t i = 0; i < vertices.size(); ++i) {
        const glm::dvec2 uv = found[i] != kNone
                                  ? glm::dvec2(control_.mesh.uvs[found[i]])
                                  : continued(face.triangle(), static_cast<uint32_t>(vertices[i]));
        uvs[2 * i] = uv.x;
        uvs[2 * i + 1] = uv.y;
    }
}

/// The triangle's affine map from positions to UVs, at the vertex' projection into its plane.
glm::dvec2 LocalUvs::continued(uint32_t triangle, uint32_t vertex) const {
    const IndexedMesh& mesh = control_.mesh;
    const glm::uvec3 corner = mesh.position_index[triangle], uv = mesh.uv_index[triangle];
    const glm::dvec3 origin = mesh.positions[corner.x];
    const glm::dvec3 a = glm::dvec3(mesh.positions[corner.y]) - origin;
    const glm::dvec3 b = glm::dvec3(mesh.positions[corner.z]) - origin;
    const glm::dvec3 way = glm::dvec3(mesh.positions[control_.cut.origin[vertex]]) - origin;
    const glm::dvec3 normal = glm::cross(a, b);
    const double area2 = glm::dot(normal, normal);
    const glm::dvec2 uv_origin = mesh.uvs[uv.x];
    if (!(area2 > 0))
        return uv_origin;
    const double along_a = glm::dot(glm::cross(way, b), normal) / area2;
    const double along_b = glm::dot(glm::cross(a, way), normal) / area2;
    return uv_origin + along_a * (glm::dvec2(mesh.uvs[uv.y]) - uv_origin) +
           along_b * (glm::dvec2(mesh.uvs[uv.z]) - uv_origin);
}

} // namespace rapport
