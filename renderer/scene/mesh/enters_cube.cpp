#include "renderer/scene/mesh/enters_cube.h"

#include <algorithm>
#include <array>
#include <vector>

namespace rapport {
namespace {

using Polygon = std::vector<glm::dvec3>;

/// What of a convex polygon lies where `distance` is positive (Sutherland and Hodgman, Reentrant
/// polygon clipping, 1974).
template <class Distance> Polygon clipped(const Polygon& polygon, const Distance& distance) {
    Polygon inside;
    for (size_t i = 0; i < polygon.size(); ++i) {
        const glm::dvec3 &a = polygon[i], &b = polygon[(i + 1) % polygon.size()];
        const double at_a = distance(a), at_b = distance(b);
        if (at_a > 0)
            inside.push_back(a);
        if ((at_a > 0) != (at_b > 0))
            inside.push_back(a + at_a / (at_a - at_b) * (b - a));
    }
    return inside;
}

bool enters_cube(const std::array<glm::dvec3, 3>& corners) {
    for (int axis = 0; axis < 3; ++axis)
        for (const double side : {-1.0, 1.0})
            if (std::ranges::all_of(corners,
                                    [&](const glm::dvec3& p) { return side * p[axis] >= 1; }))
                return false;
    Polygon polygon(corners.begin(), corners.end());
    for (int axis = 0; axis < 3; ++axis)
        for (const double side : {-1.0, 1.0})
            polygon = clipped(polygon, [&](const glm::dvec3& p) { return 1 - side * p[axis]; });
    return !polygon.empty();
}

} // namespace

bool enters_cube(const TriangleMesh& mesh, const glm::dmat4& to_cube) {
    return std::ranges::any_of(mesh.triangles, [&](const glm::uvec3& triangle) {
        std::array<glm::dvec3, 3> corners;
        for (int i = 0; i < 3; ++i)
            corners[i] = to_cube * glm::dvec4(mesh.positions[triangle[i]], 1);
        return enters_cube(corners);
    });
}

} // namespace rapport
