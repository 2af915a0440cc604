#include "renderer/scene/mesh/manifold.h"

#include "renderer/scene/mesh/disjoint_sets.h"
#include "renderer/scene/mesh/mesh_cleaning.h"

#include <algorithm>
#include <limits>

namespace rapport {
namespace {

constexpr uint32_t kNone = std::numeric_limits<uint32_t>::max();

/// The triangle's corner at the edge's low or high vertex, numbered over all triangles.
uint32_t low_corner(const EdgeUse& use) {
    return 3 * use.triangle + (use.forward ? use.corner : (use.corner + 1) % 3);
}
uint32_t high_corner(const EdgeUse& use) {
    return 3 * use.triangle + (use.forward ? (use.corner + 1) % 3 : use.corner);
}

} // namespace

ManifoldMesh cut_to_manifold(const std::vector<glm::uvec3>& triangles,
                             const std::vector<char>& detached) {
    ManifoldMesh cut;
    cut.triangles.resize(triangles.size());
    cut.straight.assign(triangles.size(), glm::bvec3(false));
    size_t vertex_count = 0;
    for (const glm::uvec3& t : triangles)
        vertex_count = std::max<size_t>(vertex_count, std::max({t.x, t.y, t.z}) + size_t{1});
    std::vector<char> pinned(vertex_count, 0); // by uncut vertex

    // Corners that touch along a sound edge belong to one fan, and a fan becomes one vertex.
    DisjointSets fans(3 * triangles.size());
    for_each_edge(edge_uses(triangles), [&](std::span<const EdgeUse> edge) {
        const bool manifold = is_manifold(edge);
        bool sound = manifold;
        for (const EdgeUse& use : edge)
            sound = sound && !detached[use.triangle];
        cut.non_manifold_edges += manifold ? 0 : 1;
        if (sound && edge.size() == 2) {
            fans.join(low_corner(edge[0]), low_corner(edge[1]));
            fans.join(high_corner(edge[0]), high_corner(edge[1]));
        }
        if (!sound) {
            pinned[edge[0].low] = pinned[edge[0].high] = 1;
            for (const EdgeUse& use : edge)
                cut.straight[use.triangle][use.corner] = true;
        }
    });

    std::vector<uint32_t> vertex_of_fan(3 * triangles.size(), kNone);
    std::vector<char> has_fan(vertex_count, 0);
    for (const bool second_round : {false, true}) {
        for (uint32_t t = 0; t < triangles.size(); ++t) {
            if ((detached[t] != 0) != second_round)
                continue;
            for (uint32_t c = 0; c < 3; ++c) {
                uint32_t& vertex = vertex_of_fan[fans.find(3 * t + c)];
                if (vertex == kNone) {
                    const uint32_t origin = triangles[t][c];
                    vertex = static_cast<uint32_t>(cut.origin.size());
                    cut.origin.push_back(origin);
                    if (has_fan[origin] && !pinned[origin]) {
                        pinned[origin] = 1;
                        ++cut.bow_ties;
                    }
                    has_fan[origin] = 1;
                }
                cut.triangles[t][c] = vertex;
            }
        }
        if (!second_round)
            cut.attached_vertices = static_cast<uint32_t>(cut.origin.size());
    }
    for (const uint32_t origin : cut.origin)
        cut.pinned.push_back(pinned[origin]);
    return cut;
}

} // namespace rapport
