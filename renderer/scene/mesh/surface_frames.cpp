#include "renderer/scene/mesh/surface_frames.h"

#include <algorithm>
#include <functional>
#include <numeric>
#include <queue>
#include <span>
#include <tuple>

namespace rapport {
namespace {

/// Smallest sine of the angle between weft and warp, and relative UV area, of a sound frame.
constexpr double kLeastSine = 1e-3;
constexpr double kLeastUvSine = 1e-8;

bool is_usable(double x) { return x > 0 && std::isfinite(x); }

/// Whether a vector of this length can be kept as floats, and its square too.
bool fits_float(double length) { return length > 1e-18 && length < 1e18; }

glm::dvec3 corner_normal(const std::vector<glm::vec3>& p, const glm::uvec3& t) {
    const glm::dvec3 origin = p[t.x];
    return glm::cross(glm::dvec3(p[t.y]) - origin, glm::dvec3(p[t.z]) - origin);
}

glm::vec3 into_tangent_plane(const glm::vec3& v, const glm::vec3& normal) {
    return v - glm::dot(v, normal) * normal;
}

/// Per vertex: the other corners of its triangles.
class Neighbours {
  public:
    Neighbours(size_t vertex_count, const std::vector<glm::uvec3>& triangles)
        : first_(vertex_count + 1, 0), other_(6 * triangles.size()) {
        for (const glm::uvec3& t : triangles)
            for (int c = 0; c < 3; ++c)
                first_[t[c] + 1] += 2;
        std::partial_sum(first_.begin(), first_.end(), first_.begin());
        std::vector<size_t> next(first_.begin(), first_.end() - 1);
        for (const glm::uvec3& t : triangles)
            for (int c = 0; c < 3; ++c)
                for (int d = 1; d < 3; ++d)
                    other_[next[t[c]]++] = t[(c + d) % 3];
    }
    std::span<const uint32_t> of(uint32_t vertex) const {
        return std::span(other_).subspan(first_[vertex], first_[vertex + 1] - first_[vertex]);
    }

  private:
    std::vector<size_t> first_;
    std::vector<uint32_t> other_;
};

} // namespace

WeftWarp weft_warp(const glm::dvec3& position_s, const glm::dvec3& position_t,
                   const glm::dvec2& uv_s, const glm::dvec2& uv_t, const glm::dvec3& normal) {
    const double determinant = uv_s.x * uv_t.y - uv_s.y * uv_t.x;
    const double scale = glm::length(uv_s) * glm::length(uv_t);
    if (!is_usable(scale) || !(std::abs(determinant) > kLeastUvSine * scale))
        return {{}, {}, false};
    glm::dvec3 weft = (uv_t.y * position_s - uv_s.y * position_t) / determinant;
    const glm::dvec3 warp = (uv_s.x * position_t - uv_t.x * position_s) / determinant;
    const glm::dvec3 cross = glm::cross(weft, warp);
    const double side = glm::dot(cross, normal), sides = glm::length(weft) * glm::length(warp);
    if (!fits_float(glm::length(weft)) || !fits_float(glm::length(warp)) ||
        !(std::abs(side) > kLeastSine * sides))
        return {{}, {}, false};
    if (side < 0)
        weft = -weft;
    return {weft, warp, true};
}

WeftWarp weft_across(const glm::dvec3& warp, const glm::dvec3& normal) {
    const glm::dvec3 flat = warp - glm::dot(warp, normal) * normal;
    const double length = glm::length(flat);
    if (!is_usable(length) || !(length > kLeastSine * glm::length(warp)))
        return {{}, {}, false};
    const glm::dvec3 unit = flat / length;
    return {glm::cross(unit, normal), unit, true};
}

bool has_mirrored_uvs(const IndexedMesh& mesh, size_t triangle) {
    const glm::uvec3 t = mesh.uv_index[triangle];
    const glm::dvec2 origin = mesh.uvs[t.x];
    const glm::dvec2 a = glm::dvec2(mesh.uvs[t.y]) - origin, b = glm::dvec2(mesh.uvs[t.z]) - origin;
    return a.x * b.y - a.y * b.x < 0;
}

size_t repair_frames(TriangleMesh& mesh, std::vector<char> sound) {
    const size_t repaired = static_cast<size_t>(std::count(sound.begin(), sound.end(), 0));
    if (repaired == 0)
        return 0;
    const Neighbours neighbours(mesh.positions.size(), mesh.triangles);
    // Dijkstra's algorithm from all sound vertices at once; equal distances go by index.
    using Step = std::tuple<float, uint32_t, uint32_t>; // distance, vertex, whose frame it takes
    std::priority_queue<Step, std::vector<Step>, std::greater<>> steps;
    const auto reach_on = [&](uint32_t from, float distance) {
        for (const uint32_t vertex : neighbours.of(from))
            if (!sound[vertex])
                steps.emplace(distance +
                                  glm::distance(mesh.positions[from], mesh.positions[vertex]),
                              vertex, from);
    };
    const std::vector<char> sound_at_first = sound;
    for (uint32_t v = 0; v < sound.size(); ++v)
        if (sound_at_first[v])
            reach_on(v, 0);
    while (!steps.empty()) {
        const auto [distance, vertex, from] = steps.top();
        steps.pop();
        if (sound[vertex])
            continue;
        const glm::vec3 normal = mesh.normals[vertex];
        const glm::vec3 weft = into_tangent_plane(mesh.weft[from], normal);
        const glm::vec3 warp = into_tangent_plane(mesh.warp[from], normal);
        const float area = glm::dot(glm::cross(weft, warp), normal);
        if (!(area > float(kLeastSine) * glm::length(weft) * glm::length(warp)))
            continue; // the surface turns too sharply on this way
        mesh.weft[vertex] = weft, mesh.warp[vertex] = warp;
        sound[vertex] = 1;
        reach_on(vertex, distance);
    }
    for (size_t v = 0; v < sound.size(); ++v)
        if (!sound[v]) {
            const Frame frame = Frame::about(mesh.normals[v]);
            mesh.weft[v] = frame.x, mesh.warp[v] = frame.y;
        }
    return repaired;
}

std::vector<glm::vec3> smooth_normals(const std::vector<glm::vec3>& positions,
                                      const std::vector<glm::uvec3>& triangles) {
    std::vector<glm::dvec3> sums(positions.size(), glm::dvec3(0));
    for (const glm::uvec3& t : triangles) {
        const glm::dvec3 normal = corner_normal(positions, t);
        const double length = glm::length(normal);
        if (!is_usable(length))
            continue;
        for (int c = 0; c < 3; ++c) {
            const glm::dvec3 corner = positions[t[c]];
            const glm::dvec3 a = glm::dvec3(positions[t[(c + 1) % 3]]) - corner;
            const glm::dvec3 b = glm::dvec3(positions[t[(c + 2) % 3]]) - corner;
            sums[t[c]] += normal * (std::atan2(length, glm::dot(a, b)) / length);
        }
    }
    std::vector<glm::vec3> normals;
    normals.reserve(sums.size());
    for (const glm::dvec3& sum : sums) {
        const double length = glm::length(sum);
        normals.push_back(is_usable(length) ? glm::vec3(sum / length) : glm::vec3(0, 0, 1));
    }
    return normals;
}

size_t add_frames(TriangleMesh& mesh) {
    const size_t count = mesh.positions.size();
    const bool has_normals = !mesh.normals.empty();
    if (!has_normals)
        mesh.normals = smooth_normals(mesh.positions, mesh.triangles);
    std::vector<glm::dvec3> weft(count, glm::dvec3(0)), warp(count, glm::dvec3(0));
    std::vector<double> weight(count, 0);
    for (const glm::uvec3& t : mesh.triangles) {
        const double area = glm::length(corner_normal(mesh.positions, t));
        const glm::dvec3 face =
            glm::normalize(mesh.normals[t.x] + mesh.normals[t.y] + mesh.normals[t.z]);
        const glm::dvec3 origin = mesh.positions[t.x];
        const glm::dvec2 uv_origin = mesh.uvs[t.x];
        const WeftWarp frame = weft_warp(
            glm::dvec3(mesh.positions[t.y]) - origin, glm::dvec3(mesh.positions[t.z]) - origin,
            glm::dvec2(mesh.uvs[t.y]) - uv_origin, glm::dvec2(mesh.uvs[t.z]) - uv_origin, face);
        if (!frame.sound)
            continue;
        for (int c = 0; c < 3; ++c) {
            weft[t[c]] += area * frame.weft;
            warp[t[c]] += area * frame.warp;
            weight[t[c]] += area;
        }
    }
    std::vector<char> sound(count, 0);
    mesh.weft.assign(count, glm::vec3(0));
    mesh.warp.assign(count, glm::vec3(0));
    for (size_t v = 0; v < count; ++v) {
        const double sine = glm::dot(glm::cross(weft[v], warp[v]), glm::dvec3(mesh.normals[v])) /
                            (glm::length(weft[v]) * glm::length(warp[v]));
        sound[v] = sine > kLeastSine; // false for NaN
        if (sound[v])
            mesh.weft[v] = weft[v] / weight[v], mesh.warp[v] = warp[v] / weight[v];
    }
    const size_t repaired = repair_frames(mesh, std::move(sound));
    if (!has_normals)
        mesh.normals.clear();
    return repaired;
}

} // namespace rapport
