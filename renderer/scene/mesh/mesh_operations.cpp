#include "renderer/scene/mesh/mesh_operations.h"

#include <algorithm>
#include <utility>

namespace rapport {
namespace {

void turn_round(TriangleMesh& mesh) {
    for (glm::uvec3& triangle : mesh.triangles)
        std::swap(triangle.y, triangle.z);
}

} // namespace

bool has_far_positions(const TriangleMesh& mesh) {
    return !std::ranges::all_of(mesh.positions, [](const glm::vec3& p) {
        return glm::all(glm::lessThan(glm::abs(p), glm::vec3(kMaxCoordinate)));
    });
}

void transform(TriangleMesh& mesh, const glm::mat4& matrix) {
    const glm::mat3 linear(matrix);
    for (glm::vec3& p : mesh.positions)
        p = glm::vec3(matrix * glm::vec4(p, 1));
    for (auto* derivative : {&mesh.weft, &mesh.warp})
        for (glm::vec3& d : *derivative)
            d = linear * d;
    if (!mesh.normals.empty()) {
        const glm::mat3 normal_map = glm::transpose(glm::inverse(linear));
        for (glm::vec3& n : mesh.normals)
            n = glm::normalize(normal_map * n);
    }
    if (glm::determinant(linear) < 0)
        turn_round(mesh);
}

void reverse_orientation(TriangleMesh& mesh) {
    turn_round(mesh);
    for (glm::vec3& n : mesh.normals)
        n = -n;
}

void orient_by_normals(TriangleMesh& mesh) {
    if (mesh.normals.empty())
        return;
    const auto& p = mesh.positions;
    const auto& n = mesh.normals;
    for (glm::uvec3& t : mesh.triangles) {
        const glm::vec3 face = glm::cross(p[t.y] - p[t.x], p[t.z] - p[t.x]);
        if (glm::dot(face, n[t.x] + n[t.y] + n[t.z]) < 0)
            std::swap(t.y, t.z);
    }
}

glm::vec3 triangle_warp(const TriangleMesh& mesh, uint32_t index) {
    const glm::uvec3 t = mesh.triangles[index];
    const glm::vec2 a = mesh.uvs[t.y] - mesh.uvs[t.x], b = mesh.uvs[t.z] - mesh.uvs[t.x];
    const float determinant = a.x * b.y - a.y * b.x;
    if (determinant == 0)
        return glm::vec3(0);
    const glm::vec3 p = mesh.positions[t.y] - mesh.positions[t.x];
    const glm::vec3 q = mesh.positions[t.z] - mesh.positions[t.x];
    return (a.x * q - b.x * p) / determinant;
}

TriangleMesh box(const glm::vec3& low, const glm::vec3& high) {
    TriangleMesh mesh;
    for (int corner = 0; corner < 8; ++corner)
        mesh.positions.emplace_back(corner & 1 ? high.x : low.x, corner & 2 ? high.y : low.y,
                                    corner & 4 ? high.z : low.z);
    mesh.triangles = {{0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6}, {0, 1, 5}, {0, 5, 4},
                      {2, 6, 7}, {2, 7, 3}, {0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}};
    return mesh;
}

} // namespace rapport
