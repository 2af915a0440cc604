#include "renderer/scene/mesh/mesh_cleaning.h"

#include "renderer/scene/mesh/manifold.h"

#include <gtest/gtest.h>

namespace rapport {
namespace {

std::vector<char> none_detached(const std::vector<glm::uvec3>& triangles) {
    return std::vector<char>(triangles.size(), 0);
}

size_t count_non_manifold(const std::vector<glm::uvec3>& triangles) {
    size_t count = 0;
    for_each_edge(edge_uses(triangles),
                  [&](std::span<const EdgeUse> edge) { count += is_manifold(edge) ? 0 : 1; });
    return count;
}

TEST(MeshCleaning, MergesByValueAndDropsTheUnused) {
    IndexedMesh mesh;
    mesh.positions = {{9, 9, 9},     {0, 0, 0}, {1, 0, 0}, {0, 1, 0},
                      {1, 0, -0.0f}, {0, 1, 0}, {1, 1, 0}};
    mesh.uvs = {{0, 0}, {1, 0}, {0, 1}, {1, 0}, {0, 1}, {1, 1}};
    mesh.position_index = {{1, 2, 3}, {5, 4, 6}};
    mesh.uv_index = {{0, 1, 2}, {4, 3, 5}};
    const CleanMesh merged(mesh);
    EXPECT_EQ(merged.positions.size(), 4u);
    EXPECT_EQ(merged.uvs.size(), 4u);
    EXPECT_EQ(merged.position_index, (std::vector<glm::uvec3>{{0, 1, 2}, {2, 1, 3}}));
    EXPECT_EQ(merged.uv_index, (std::vector<glm::uvec3>{{0, 1, 2}, {2, 1, 3}}));
    EXPECT_EQ(merged.positions[3], glm::vec3(1, 1, 0));
    EXPECT_EQ(merged.dropped.vertices, 2u);
    mesh.uvs[3].x += 1; // a seam repeats no vertex
    mesh.uvs[4].x += 1;
    EXPECT_EQ(CleanMesh(mesh).dropped.vertices, 0u);
}

TEST(MeshCleaning, UvsThatDifferStayApart) {
    IndexedMesh mesh;
    mesh.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}};
    mesh.uvs = {{0, 0}, {1, 0}, {0, 1}, {5, 0}, {5, 1}, {6, 1}};
    mesh.position_index = {{0, 1, 2}, {2, 1, 3}};
    mesh.uv_index = {{0, 1, 2}, {4, 3, 5}};
    const CleanMesh merged(mesh);
    EXPECT_EQ(merged.positions.size(), 4u);
    EXPECT_EQ(merged.uvs.size(), 6u);
}

TEST(MeshCleaning, DropsWhatIsNoSurfaceAndCountsIt) {
    IndexedMesh mesh;
    mesh.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 0, 0}, {2, 0, 0}, {7, 7, 7}};
    mesh.position_index = {{0, 1, 2},  // sound
                           {1, 1, 5},  // two corners the same
                           {0, 1, 3},  // two corners at one point
                           {2, 0, 3},  // the first again
                           {1, 0, 2},  // and seen from behind
                           {0, 1, 4}}; // a sliver, but with three different corners
    mesh.uvs = {{0, 0}, {1, 1}};
    mesh.uv_index = {{0, 0, 0}, {1, 1, 1}, {1, 1, 1}, {1, 1, 1}, {1, 1, 1}, {0, 0, 1}};
    const CleanMesh cleaned(mesh);
    EXPECT_EQ(cleaned.dropped.degenerate, 2u);
    EXPECT_EQ(cleaned.dropped.repeated, 2u);
    EXPECT_EQ(cleaned.dropped.collinear, 1u);
    EXPECT_EQ(cleaned.position_index, (std::vector<glm::uvec3>{{0, 1, 2}, {0, 1, 3}}));
    EXPECT_EQ(cleaned.uv_index, (std::vector<glm::uvec3>{{0, 0, 0}, {0, 0, 1}}));
    EXPECT_EQ(cleaned.positions.size(), 4u); // (7, 7, 7) is used by nobody now
}

TEST(MeshCleaning, FindsNonManifoldEdges) {
    EXPECT_EQ(count_non_manifold({{0, 1, 2}, {1, 0, 3}}), 0u);
    EXPECT_EQ(count_non_manifold({{0, 1, 2}, {0, 1, 3}}), 1u);            // one is flipped
    EXPECT_EQ(count_non_manifold({{0, 1, 2}, {1, 0, 3}, {0, 1, 4}}), 1u); // three at an edge
}

TEST(Manifold, SoundMeshesStayWhole) {
    const std::vector<glm::uvec3> tetrahedron = {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}};
    const ManifoldMesh cut = cut_to_manifold(tetrahedron, none_detached(tetrahedron));
    EXPECT_EQ(cut.origin.size(), 4u);
    EXPECT_EQ(cut.attached_vertices, 4u);
    EXPECT_EQ(cut.non_manifold_edges, 0u);
    EXPECT_EQ(cut.bow_ties, 0u);
    for (size_t t = 0; t < 4; ++t)
        for (int c = 0; c < 3; ++c) {
            EXPECT_EQ(cut.origin[cut.triangles[t][c]], tetrahedron[t][c]);
            EXPECT_FALSE(cut.straight[t][c]);
        }
    EXPECT_EQ(cut.pinned, std::vector<char>(4, 0));
}

TEST(Manifold, CutsBowTies) {
    const std::vector<glm::uvec3> bow_tie = {{0, 1, 2}, {0, 3, 4}};
    const ManifoldMesh cut = cut_to_manifold(bow_tie, none_detached(bow_tie));
    EXPECT_EQ(cut.origin.size(), 6u);
    EXPECT_EQ(cut.bow_ties, 1u);
    EXPECT_NE(cut.triangles[0].x, cut.triangles[1].x);
    EXPECT_TRUE(cut.pinned[cut.triangles[0].x]);
    EXPECT_TRUE(cut.pinned[cut.triangles[1].x]);
    EXPECT_FALSE(cut.pinned[cut.triangles[0].y]);
}

TEST(Manifold, WhatIsLeftIsAManifold) {
    // Three sheets on an edge; a flipped neighbour; a fin on a closed fan; a detached triangle.
    const std::vector<std::vector<glm::uvec3>> meshes = {
        {{0, 1, 2}, {1, 0, 3}, {0, 1, 4}},
        {{0, 1, 2}, {0, 1, 3}, {1, 2, 4}},
        {{0, 1, 2}, {0, 2, 3}, {0, 3, 4}, {0, 4, 1}, {0, 1, 5}}};
    for (const auto& triangles : meshes)
        for (const bool detach_first : {false, true}) {
            std::vector<char> detached = none_detached(triangles);
            detached[0] = detach_first;
            const ManifoldMesh cut = cut_to_manifold(triangles, detached);
            EXPECT_GE(cut.non_manifold_edges, 1u);
            EXPECT_EQ(count_non_manifold(cut.triangles), 0u);
            if (detach_first)
                for (int c = 0; c < 3; ++c) {
                    EXPECT_GE(cut.triangles[0][c], cut.attached_vertices);
                    EXPECT_TRUE(cut.straight[0][c]);
                    EXPECT_TRUE(cut.pinned[cut.triangles[0][c]]);
                }
        }
}

} // namespace
} // namespace rapport
