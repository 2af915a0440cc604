#include "renderer/scene/mesh/sharp_turns.h"

#include "renderer/core/parallel.h"

#include <algorithm>
#include <cmath>

namespace rapport {
namespace {

constexpr float kMostTilt = radians(60.0f);
/// By which a rate rises at most before the surface is looked at again.
constexpr float kMostAtOnce = 8;
constexpr size_t kFacesPerBatch = 256;

/// Where the surface is sharp, and normals say nothing of how finely it is cut.
bool is_sharp_corner(const ControlMesh& control, const Tessellation::Vertex& vertex) {
    return vertex.side != Tessellation::kInside && vertex.step == 0 &&
           control.cut.pinned[control.vertex(vertex.side)];
}

/// The largest angle between a triangle's normal and those at its corners [rad].
float largest_tilt(const ControlMesh& control, const Tessellation& tessellation,
                   const TriangleMesh& mesh, const glm::uvec3& triangle) {
    const auto& p = mesh.positions;
    const glm::vec3 normal =
        glm::cross(p[triangle.y] - p[triangle.x], p[triangle.z] - p[triangle.x]);
    const float length = glm::length(normal);
    if (!(length > 0))
        return 0;
    float least_cosine = 1;
    for (int c = 0; c < 3; ++c) {
        const float cosine = glm::dot(mesh.normals[triangle[c]], normal) / length;
        if (cosine < least_cosine && !is_sharp_corner(control, tessellation.vertices[triangle[c]]))
            least_cosine = cosine;
    }
    return std::acos(std::max(least_cosine, -1.0f));
}

} // namespace

bool refine_sharp_turns(const ControlMesh& control, const Tessellation& tessellation,
                        const TriangleMesh& mesh, const EdgeRate& finest, SideRates& rates) {
    std::vector<float> wanted(control.cut.triangles.size(), 1); // times as many pieces
    const size_t faces = control.faces.size();
    parallel_for((faces + kFacesPerBatch - 1) / kFacesPerBatch, [&](size_t batch) {
        const size_t end = std::min(faces, (batch + 1) * kFacesPerBatch);
        for (size_t face = batch * kFacesPerBatch; face < end; ++face) {
            float tilt = 0;
            for (size_t t = tessellation.first_triangle[face];
                 t < tessellation.first_triangle[face + 1]; ++t)
                tilt = std::max(
                    tilt, largest_tilt(control, tessellation, mesh, tessellation.triangles[t]));
            if (tilt > kMostTilt)
                for (uint32_t i = 0; i < control.faces[face].size; ++i)
                    wanted[control.faces[face].side[i] / 3] =
                        std::min(std::ceil(tilt / kMostTilt), kMostAtOnce);
        }
    });
    bool rose = false;
    for_each_edge(control.edges, [&](std::span<const EdgeUse> edge) {
        float times = 1;
        for (const EdgeUse& use : edge) {
            if (control.cut.straight[use.triangle][use.corner])
                return; // all pieces of a cut edge must stay alike
            times = std::max(times, wanted[use.triangle]);
        }
        const uint32_t first = 3 * edge[0].triangle + edge[0].corner;
        if (times == 1)
            return;
        const auto most = std::max(rates[first], pieces_of(control, edge, finest));
        const auto raised = static_cast<uint16_t>(std::min<float>(most, times * rates[first]));
        if (raised == rates[first])
            return;
        rose = true;
        for (const EdgeUse& use : edge)
            rates[3 * use.triangle + use.corner] = raised;
    });
    return rose;
}

} // namespace rapport
