#include "renderer/scene/shape/shape.h"

#include <fmt/format.h>

namespace rapport {
namespace {

/// Triangles written in the scene file.
///     "point3 P"         vertex positions; required
///     "integer indices"  three per triangle; may be left out for a single triangle
///     "normal N"         a shading normal per vertex
///     "point2 uv"        per vertex
std::vector<ShapePart> make_trianglemesh(const ShapeContext& context) {
    const Params& params = context.params;
    TriangleMesh mesh;
    mesh.positions = params.get_point3s("P");
    mesh.normals = params.get_point3s("N");
    mesh.uvs = params.get_point2s("uv");
    const size_t vertices = mesh.positions.size();
    if (vertices == 0)
        params.fail("P", "\"point3 P\" with the vertices", "none");
    for (const auto& [name, count] : {std::pair{"N", mesh.normals.size()}, {"uv", mesh.uvs.size()}})
        if (count != 0 && count != vertices)
            params.fail(name, fmt::format("one for each of the {} vertices", vertices),
                        std::to_string(count));
    for (glm::vec3& n : mesh.normals) {
        if (!(glm::length(n) > 0))
            params.fail("N", "normals that have a length", "(0 0 0)");
        n = glm::normalize(n);
    }

    std::vector<int> indices = params.get_ints("indices");
    if (indices.empty() && vertices == 3)
        indices = {0, 1, 2};
    if (indices.empty() || indices.size() % 3 != 0)
        params.fail("indices", "three indices per triangle", fmt::format("{}", indices.size()));
    for (const int index : indices)
        if (index < 0 || static_cast<size_t>(index) >= vertices)
            params.fail("indices", fmt::format("vertex numbers from 0 to {}", vertices - 1),
                        std::to_string(index));
    for (size_t i = 0; i < indices.size(); i += 3)
        mesh.triangles.emplace_back(indices[i], indices[i + 1], indices[i + 2]);
    return {{std::move(mesh), ""}};
}

const Registered<ShapeFactory> registered("trianglemesh", make_trianglemesh);

} // namespace
} // namespace rapport
