#include "renderer/scene/mesh/auto_uvs.h"

#include <cmath>

namespace rapport {
namespace {

/// The directions of +u and +v on what faces along an axis, u × v pointing out of the face.
struct Projection {
    glm::vec3 u, v;
};

Projection projection(const glm::vec3& normal) {
    const glm::vec3 size = glm::abs(normal);
    if (size.y > size.x && size.y > size.z)
        return normal.y > 0 ? Projection{{1, 0, 0}, {0, 0, -1}}
                            : Projection{{-1, 0, 0}, {0, 0, -1}};
    const glm::vec3 up(0, 1, 0);
    if (size.x > size.z)
        return {{0, 0, normal.x > 0 ? -1 : 1}, up};
    return {{normal.z > 0 ? 1 : -1, 0, 0}, up};
}

} // namespace

void add_auto_uvs(IndexedMesh& mesh) {
    const auto& p = mesh.positions;
    mesh.uvs.reserve(3 * mesh.position_index.size());
    for (const glm::uvec3& t : mesh.position_index) {
        const Projection onto = projection(glm::cross(p[t.y] - p[t.x], p[t.z] - p[t.x]));
        const auto first = static_cast<uint32_t>(mesh.uvs.size());
        for (int c = 0; c < 3; ++c)
            mesh.uvs.emplace_back(glm::dot(p[t[c]], onto.u), glm::dot(p[t[c]], onto.v));
        mesh.uv_index.emplace_back(first, first + 1, first + 2);
    }
}

} // namespace rapport
