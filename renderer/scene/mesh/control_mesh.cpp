#include "renderer/scene/mesh/control_mesh.h"

#include "renderer/scene/mesh/disjoint_sets.h"
#include "renderer/scene/mesh/t_junctions.h"

#include <cmath>
#include <optional>

namespace rapport {
namespace {

/// Of an edge with two triangles: their corners at its low vertex, and at its high one.
struct EdgeCorners {
    uint32_t low[2], high[2];
};
EdgeCorners corners_of(std::span<const EdgeUse> edge) {
    EdgeCorners corners;
    for (size_t i = 0; i < 2; ++i) {
        const uint32_t side = 3 * edge[i].triangle + edge[i].corner, next = next_side(side);
        corners.low[i] = edge[i].forward ? side : next;
        corners.high[i] = edge[i].forward ? next : side;
    }
    return corners;
}

class CreaseFinder {
  public:
    CreaseFinder(const IndexedMesh& mesh, double angle)
        : mesh_(mesh), least_cosine_(std::cos(angle)) {}

    bool is_crease(const EdgeCorners& corners) const {
        return !mesh_.normal_index.empty() &&
               (differ(corners.low[0], corners.low[1]) || differ(corners.high[0], corners.high[1]));
    }

  private:
    glm::dvec3 normal(uint32_t corner) const {
        return mesh_.normals[mesh_.normal_index[corner / 3][static_cast<int>(corner % 3)]];
    }
    bool differ(uint32_t a, uint32_t b) const {
        const glm::dvec3 n = normal(a), m = normal(b);
        return glm::dot(n, m) < least_cosine_ * glm::length(n) * glm::length(m);
    }

    const IndexedMesh& mesh_;
    double least_cosine_;
};

/// The quad that two triangles make across an edge, if they are fit for it.
std::optional<Face> make_quad(const ControlMesh& control, std::span<const EdgeUse> edge) {
    const EdgeCorners corners = corners_of(edge);
    const uint32_t diagonal = 3 * edge[0].triangle + edge[0].corner;
    if (control.crease[diagonal] || control.uv(corners.low[0]) != control.uv(corners.low[1]) ||
        control.uv(corners.high[0]) != control.uv(corners.high[1]))
        return std::nullopt;
    const uint32_t a = next_side(diagonal);
    const uint32_t b = next_side(3 * edge[1].triangle + edge[1].corner);
    const Face quad{{a, next_side(a), b, next_side(b)}, 4};
    std::array<glm::dvec3, 4> p;
    for (size_t i = 0; i < 4; ++i)
        p[i] = control.position(quad.side[i]);
    const glm::dvec3 normal = glm::cross(p[2] - p[0], p[3] - p[1]);
    for (size_t i = 0; i < 4; ++i)
        if (!(glm::dot(normal, glm::cross(p[(i + 1) % 4] - p[i], p[(i + 3) % 4] - p[i])) > 0))
            return std::nullopt;
    return quad;
}

/// Per triangle, the quad that it makes with the next one of the file.
std::vector<std::optional<Face>> find_quads(const ControlMesh& control) {
    std::vector<std::optional<Face>> with_next(control.cut.triangles.size());
    for_each_edge(control.edges, [&](std::span<const EdgeUse> edge) {
        if (edge.size() == 2 && edge[0].triangle + 1 == edge[1].triangle &&
            !control.detached[edge[0].triangle] && !control.detached[edge[1].triangle])
            with_next[edge[0].triangle] = make_quad(control, edge);
    });
    return with_next;
}

void make_faces(ControlMesh& control, bool quads) {
    const auto count = static_cast<uint32_t>(control.cut.triangles.size());
    std::vector<std::optional<Face>> with_next(count);
    if (quads)
        with_next = find_quads(control);
    control.faces.reserve(count);
    for (uint32_t t = 0; t < count; ++t) {
        if (with_next[t]) {
            control.faces.push_back(*with_next[t]);
            control.has_quads = true;
            ++t;
        } else {
            control.faces.push_back({{3 * t, 3 * t + 1, 3 * t + 2}, 3});
        }
    }
}

} // namespace

ControlMesh make_control_mesh(const IndexedMesh& mesh, const std::vector<char>& detached,
                              const ControlMeshOptions& options) {
    ControlMesh control{mesh, cut_to_manifold(mesh.position_index, detached), detached};
    const size_t corners = 3 * mesh.position_index.size();
    control.edges = edge_uses(control.cut.triangles);
    control.crease.assign(corners, 0);
    const CreaseFinder finder(mesh, options.crease_angle);
    DisjointSets smooth(corners);
    for_each_edge(control.edges, [&](std::span<const EdgeUse> edge) {
        if (edge.size() != 2)
            return;
        const EdgeCorners at = corners_of(edge);
        if (finder.is_crease(at)) {
            for (const EdgeUse& use : edge)
                control.crease[3 * use.triangle + use.corner] = 1;
        } else {
            smooth.join(at.low[0], at.low[1]);
            smooth.join(at.high[0], at.high[1]);
        }
    });
    control.smooth_group.resize(corners);
    for (uint32_t c = 0; c < corners; ++c)
        control.smooth_group[c] = smooth.find(c);
    control.t_junctions = hold_t_junctions(control);
    make_faces(control, options.quads);
    return control;
}

} // namespace rapport
