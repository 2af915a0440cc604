#include "renderer/scene/mesh/subdivision.h"

#include "renderer/scene/mesh/surface_frames.h"

#include <array>
#include <map>

namespace rapport {

TriangleMesh flat_mesh(const IndexedMesh& mesh, SubdivisionReport* report) {
    const bool has_uvs = !mesh.uv_index.empty(), has_normals = !mesh.normal_index.empty();
    const bool has_colors = !mesh.color_index.empty();
    const std::vector<glm::vec3> smooth = smooth_normals(mesh.positions, mesh.position_index);
    TriangleMesh result;
    result.triangles.resize(mesh.position_index.size());
    std::map<std::array<uint32_t, 4>, uint32_t> vertices; // by position, UV, normal, colour
    for (size_t t = 0; t < result.triangles.size(); ++t)
        for (int c = 0; c < 3; ++c) {
            const uint32_t position = mesh.position_index[t][c];
            const uint32_t uv = has_uvs ? mesh.uv_index[t][c] : 0;
            const uint32_t normal = has_normals ? mesh.normal_index[t][c] : 0;
            const uint32_t color = has_colors ? mesh.color_index[t][c] : 0;
            const auto [vertex, is_new] = vertices.try_emplace(
                {position, uv, normal, color}, static_cast<uint32_t>(result.positions.size()));
            result.triangles[t][c] = vertex->second;
            if (!is_new)
                continue;
            result.positions.push_back(mesh.positions[position]);
            result.normals.push_back(smooth[position]);
            if (has_uvs)
                result.uvs.push_back(mesh.uvs[uv]);
            if (has_colors)
                result.colors.push_back(mesh.colors[color]);
            const float length = has_normals ? glm::length(mesh.normals[normal]) : 0;
            if (length > 0) {
                const glm::vec3 unit = mesh.normals[normal] / length;
                const bool away = glm::dot(unit, result.normals.back()) < 0;
                result.normals.back() = away ? -unit : unit;
            }
        }
    SubdivisionReport unread;
    SubdivisionReport& counts = report ? *report : unread;
    counts = {.faces = mesh.position_index.size()};
    if (!has_uvs)
        return result;
    for (size_t t = 0; t < counts.faces; ++t)
        counts.mirrored += has_mirrored_uvs(mesh, t);
    if (mesh.warps.empty()) {
        counts.frames_repaired = add_frames(result);
        return result;
    }
    std::vector<char> sound(result.positions.size());
    result.weft.resize(sound.size());
    result.warp.resize(sound.size());
    for (const auto& [key, vertex] : vertices) {
        const WeftWarp frame = weft_across(mesh.warps[key[1]], result.normals[vertex]);
        result.weft[vertex] = frame.weft;
        result.warp[vertex] = frame.warp;
        sound[vertex] = frame.sound;
    }
    counts.frames_repaired = repair_frames(result, std::move(sound));
    return result;
}

} // namespace rapport
