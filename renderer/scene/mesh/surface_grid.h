#pragma once

#include "renderer/scene/shape/shape.h"

#include <algorithm>
#include <cmath>

namespace rapport {

struct GridPoint {
    glm::vec3 position, normal;
    glm::vec3 weft, warp; ///< directions of ∂P/∂u and ∂P/∂v, of any length above 0
};

/// A parametric surface over (u, v) in [0, 1]², as a mesh of columns × rows cells, two triangles
/// each; (weft, warp, normal) is right-handed. Triangles without area, as at poles, are left out.
template <class Point> TriangleMesh surface_grid(int columns, int rows, const Point& point) {
    TriangleMesh mesh;
    for (int j = 0; j <= rows; ++j)
        for (int i = 0; i <= columns; ++i) {
            const glm::vec2 uv(static_cast<float>(i) / static_cast<float>(columns),
                               static_cast<float>(j) / static_cast<float>(rows));
            const GridPoint p = point(uv);
            mesh.positions.push_back(p.position);
            mesh.normals.push_back(p.normal);
            mesh.weft.push_back(p.weft);
            mesh.warp.push_back(p.warp);
            mesh.uvs.push_back(uv);
        }
    const auto add = [&](uint32_t a, uint32_t b, uint32_t c) {
        const auto& p = mesh.positions;
        if (p[a] != p[b] && p[b] != p[c] && p[c] != p[a])
            mesh.triangles.emplace_back(a, b, c);
    };
    for (int j = 0; j < rows; ++j)
        for (int i = 0; i < columns; ++i) {
            const auto a = static_cast<uint32_t>(j * (columns + 1) + i);
            const auto d = a + static_cast<uint32_t>(columns) + 1;
            add(a, a + 1, d + 1);
            add(a, d + 1, d);
        }
    return mesh;
}

/// Pieces of a full circle of the shape's space, such that its chords are off by a twentieth of a
/// pixel at most: r (1 − cos(π/n)) ≈ r π²/2n².
inline int circle_pieces(const ShapeContext& context, const glm::dvec3& centre, double radius) {
    const double seen = context.seen_length(centre, centre + glm::dvec3(radius, 0, 0));
    return static_cast<int>(std::clamp(std::ceil(kPi * std::sqrt(10 * seen)), 64.0, 1024.0));
}

} // namespace rapport
