#pragma once

#include "renderer/scene/mesh/mesh.h"

#include <span>

namespace rapport {

/// What cleaning dropped, and noticed.
struct CleaningReport {
    size_t degenerate = 0; ///< triangles with two corners at one point
    size_t repeated =
        0; ///< triangles over the same three points as an earlier one, either way round
    size_t vertices = 0;  ///< equal in everything to an earlier one, merged with it
    size_t collinear = 0; ///< triangles with three corners on one line, which stay
};

/// A mesh with equal values merged (positions, UVs with their warps, normals, and colours each;
/// equal means every coordinate is, with −0 = +0), without values that nobody uses, and without
/// triangles that make no surface. Slivers with three different corners stay: dropping one would
/// open a hole. Of two coincident sheets the first stays, since light cannot tell which it meets.
/// Order is otherwise kept.
class CleanMesh : public IndexedMesh {
  public:
    CleanMesh() = default;
    CleanMesh(IndexedMesh mesh); ///< cleans it

    CleaningReport dropped;
};

/// One side of a triangle: the edge from its corner `corner` to the next.
struct EdgeUse {
    uint32_t low, high; ///< the edge's vertices, low < high
    uint32_t triangle;
    uint8_t corner;
    bool forward; ///< the triangle runs from low to high
};

/// All sides of all triangles, those of one edge together, in the order of the triangles.
std::vector<EdgeUse> edge_uses(std::span<const glm::uvec3> triangles);

/// Calls `visit(std::span<const EdgeUse>)` once per edge.
template <class Visit> void for_each_edge(std::span<const EdgeUse> uses, const Visit& visit) {
    for (size_t first = 0; first < uses.size();) {
        size_t end = first + 1;
        while (end < uses.size() && uses[end].low == uses[first].low &&
               uses[end].high == uses[first].high)
            ++end;
        visit(uses.subspan(first, end - first));
        first = end;
    }
}

/// Whether the triangles on an edge make an oriented surface there: one alone, or two that run
/// along it in opposite directions.
inline bool is_manifold(std::span<const EdgeUse> edge) {
    return edge.size() == 1 || (edge.size() == 2 && edge[0].forward != edge[1].forward);
}

} // namespace rapport
