#include "renderer/scene/local_uvs.h"

#include "renderer/scene/mesh_cleaning.h"

#include <algorithm>
#include <limits>

namespace rapport {
namespace {

constexpr uint32_t kNone = std::numeric_limits<uint32_t>::max();
constexpr uint32_t kSeveral = kNone - 1;

} // namespace

LocalUvs::LocalUvs(const ManifoldMesh& cut, const std::vector<char>& detached,
                   const IndexedMesh& mesh)
    : cut_(cut), mesh_(mesh), across_(3 * cut.triangles.size(), kNone),
      uv_of_vertex_(cut.origin.size(), kNone) {
    for (size_t t = 0; t < cut.triangles.size(); ++t)
        for (int c = 0; c < 3; ++c) {
            uint32_t& uv = uv_of_vertex_[cut.triangles[t][c]];
            uv = uv == kNone || uv == mesh.uv_index[t][c] ? mesh.uv_index[t][c] : kSeveral;
        }
    for_each_edge(edge_uses(cut.triangles), [&](std::span<const EdgeUse> edge) {
        if (edge.size() != 2 || detached[edge[0].triangle] || detached[edge[1].triangle])
            return;
        const int a = edge[0].corner, b = edge[1].corner;
        const glm::uvec3 uv_a = mesh.uv_index[edge[0].triangle];
        const glm::uvec3 uv_b = mesh.uv_index[edge[1].triangle];
        if (uv_a[a] != uv_b[(b + 1) % 3] || uv_a[(a + 1) % 3] != uv_b[b])
            return;
        const uint32_t side_a = 3 * edge[0].triangle + edge[0].corner;
        const uint32_t side_b = 3 * edge[1].triangle + edge[1].corner;
        across_[side_a] = side_b;
        across_[side_b] = side_a;
    });
}

template <class Visit> void LocalUvs::for_each_around(uint32_t triangle, const Visit& visit) const {
    visit(triangle);
    for (uint32_t corner = 0; corner < 3; ++corner)
        for (const bool forward : {true, false}) {
            // Leave by the side after the corner, or by the one before it. The neighbour runs along
            // that side the other way, so there the corner is at its end, or at its beginning.
            uint32_t side = 3 * triangle + (forward ? corner : (corner + 2) % 3);
            for (uint32_t beyond = across_[side]; beyond != kNone; beyond = across_[side]) {
                const uint32_t next = beyond / 3, c = beyond % 3;
                if (next == triangle)
                    break;
                visit(next);
                side = 3 * next + (forward ? (c + 1) % 3 : (c + 2) % 3);
            }
        }
}

void LocalUvs::gather(uint32_t triangle, std::span<const int> vertices,
                      std::span<double> uvs) const {
    thread_local std::vector<uint32_t> found; // UV index per entry of `vertices`
    found.clear();
    for (const int vertex : vertices)
        found.push_back(uv_of_vertex_[static_cast<size_t>(vertex)]);
    // One UV for each vertex: then there is no seam between them. Else look who can be reached.
    if (std::find(found.begin(), found.end(), kSeveral) != found.end()) {
        std::fill(found.begin(), found.end(), kNone);
        for_each_around(triangle, [&](uint32_t t) {
            for (int c = 0; c < 3; ++c)
                for (size_t i = 0; i < vertices.size(); ++i)
                    if (found[i] == kNone &&
                        static_cast<uint32_t>(vertices[i]) == cut_.triangles[t][c])
                        found[i] = mesh_.uv_index[t][c];
        });
    }
    for (size_t i = 0; i < vertices.size(); ++i) {
        const glm::dvec2 uv = found[i] != kNone
                                  ? glm::dvec2(mesh_.uvs[found[i]])
                                  : continued(triangle, static_cast<uint32_t>(vertices[i]));
        uvs[2 * i] = uv.x;
        uvs[2 * i + 1] = uv.y;
    }
}

/// The triangle's affine map from positions to UVs, at the vertex' projection into its plane.
glm::dvec2 LocalUvs::continued(uint32_t triangle, uint32_t vertex) const {
    const glm::uvec3 corner = mesh_.position_index[triangle], uv = mesh_.uv_index[triangle];
    const glm::dvec3 origin = mesh_.positions[corner.x];
    const glm::dvec3 a = glm::dvec3(mesh_.positions[corner.y]) - origin;
    const glm::dvec3 b = glm::dvec3(mesh_.positions[corner.z]) - origin;
    const glm::dvec3 way = glm::dvec3(mesh_.positions[cut_.origin[vertex]]) - origin;
    const glm::dvec3 normal = glm::cross(a, b);
    const double area2 = glm::dot(normal, normal);
    const glm::dvec2 uv_origin = mesh_.uvs[uv.x];
    if (!(area2 > 0))
        return uv_origin;
    const double along_a = glm::dot(glm::cross(way, b), normal) / area2;
    const double along_b = glm::dot(glm::cross(a, way), normal) / area2;
    return uv_origin + along_a * (glm::dvec2(mesh_.uvs[uv.y]) - uv_origin) +
           along_b * (glm::dvec2(mesh_.uvs[uv.z]) - uv_origin);
}

} // namespace rapport
