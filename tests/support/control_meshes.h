#pragma once

#include "renderer/scene/mesh/mesh_cleaning.h"
#include "renderer/scene/mesh/subdivision.h"

#include <algorithm>
#include <functional>
#include <gtest/gtest.h>
#include <random>

// Meshes to subdivide, and what must hold of what becomes of them.

namespace rapport::tests {

inline IndexedMesh icosahedron() {
    const float g = 1.6180339887f;
    IndexedMesh mesh;
    mesh.positions = {{-1, g, 0},  {1, g, 0},  {-1, -g, 0}, {1, -g, 0}, {0, -1, g},  {0, 1, g},
                      {0, -1, -g}, {0, 1, -g}, {g, 0, -1},  {g, 0, 1},  {-g, 0, -1}, {-g, 0, 1}};
    mesh.position_index = {{0, 11, 5}, {0, 5, 1},  {0, 1, 7},   {0, 7, 10}, {0, 10, 11},
                           {1, 5, 9},  {5, 11, 4}, {11, 10, 2}, {10, 7, 6}, {7, 1, 8},
                           {3, 9, 4},  {3, 4, 2},  {3, 2, 6},   {3, 6, 8},  {3, 8, 9},
                           {4, 9, 5},  {2, 4, 11}, {6, 2, 10},  {8, 6, 7},  {9, 8, 1}};
    return mesh;
}

/// UVs of its own for each triangle, so that every edge is a seam.
inline void add_separate_uvs(IndexedMesh& mesh) {
    for (size_t t = 0; t < mesh.position_index.size(); ++t) {
        const auto first = static_cast<uint32_t>(mesh.uvs.size());
        const auto x = static_cast<float>(2 * t);
        mesh.uvs.insert(mesh.uvs.end(), {{x, 0}, {x + 1, 0}, {x, 1}});
        mesh.uv_index.emplace_back(first, first + 1, first + 2);
    }
}

inline void add_uvs(IndexedMesh& mesh, const std::function<glm::vec2(const glm::vec3&)>& map) {
    mesh.uvs.clear();
    for (const glm::vec3& p : mesh.positions)
        mesh.uvs.push_back(map(p));
    mesh.uv_index = mesh.position_index;
}

/// A square of n × n cells over [0, 1]² with heights, each cell cut along a random diagonal, so
/// that vertices of many valences occur.
inline IndexedMesh sheet(uint32_t n, const std::function<float(float, float)>& height) {
    IndexedMesh mesh;
    std::mt19937 random(1);
    for (uint32_t j = 0; j <= n; ++j)
        for (uint32_t i = 0; i <= n; ++i) {
            const float x = float(i) / float(n), y = float(j) / float(n);
            mesh.positions.emplace_back(x, y, height(x, y));
        }
    for (uint32_t j = 0; j < n; ++j)
        for (uint32_t i = 0; i < n; ++i) {
            const uint32_t a = j * (n + 1) + i, b = a + 1, c = b + n + 1, d = a + n + 1;
            if (random() % 2) {
                mesh.position_index.emplace_back(a, b, c);
                mesh.position_index.emplace_back(a, c, d);
            } else {
                mesh.position_index.emplace_back(a, b, d);
                mesh.position_index.emplace_back(b, c, d);
            }
        }
    return mesh;
}

/// The spokes of a wheel, `count` triangles round one vertex; closed below by a second one.
inline IndexedMesh spindle(uint32_t count) {
    IndexedMesh mesh;
    mesh.positions = {{0, 0, 1}, {0, 0, -1}};
    for (uint32_t i = 0; i < count; ++i) {
        const double phi = 2 * kPi * i / count;
        mesh.positions.emplace_back(std::cos(phi), std::sin(phi), 0);
        const uint32_t a = 2 + i, b = 2 + (i + 1) % count;
        mesh.position_index.emplace_back(0, a, b);
        mesh.position_index.emplace_back(1, b, a);
    }
    return mesh;
}

/// The triangles over positions merged by value.
inline std::vector<glm::uvec3> topology(const TriangleMesh& mesh) {
    IndexedMesh indexed;
    indexed.positions = mesh.positions;
    indexed.position_index = mesh.triangles;
    const CleanMesh merged(std::move(indexed));
    EXPECT_EQ(merged.dropped.degenerate + merged.dropped.repeated, 0u);
    return merged.position_index;
}

inline void expect_closed_manifold(const TriangleMesh& mesh) {
    const std::vector<glm::uvec3> triangles = topology(mesh);
    const std::vector<EdgeUse> uses = edge_uses(triangles);
    size_t edges = 0, open = 0;
    for_each_edge(uses, [&](std::span<const EdgeUse> edge) {
        ++edges;
        open += edge.size() != 2 || !is_manifold(edge);
    });
    EXPECT_EQ(open, 0u);
    uint32_t vertices = 0;
    for (const glm::uvec3& t : triangles)
        vertices = std::max(vertices, std::max({t.x, t.y, t.z}) + 1);
    EXPECT_EQ(vertices + triangles.size(), edges + 2); // Euler: one closed surface without handles
}

inline void expect_sound(const TriangleMesh& mesh) {
    for (const glm::vec3& p : mesh.positions)
        ASSERT_TRUE(std::isfinite(p.x + p.y + p.z));
    for (const glm::vec3& n : mesh.normals)
        ASSERT_NEAR(glm::length(n), 1, 1e-5);
    for (size_t v = 0; v < mesh.weft.size(); ++v) {
        const glm::vec3 cross =
            glm::cross(glm::normalize(mesh.weft[v]), glm::normalize(mesh.warp[v]));
        ASSERT_GT(glm::dot(cross, mesh.normals[v]), 0) << v;
    }
}

inline SubdivisionOptions options(int level, bool need_uvs) {
    SubdivisionOptions options;
    options.rate = uniform_rate(level);
    options.need_uvs = need_uvs;
    return options;
}

} // namespace rapport::tests
