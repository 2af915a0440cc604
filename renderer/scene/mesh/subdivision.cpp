#include "renderer/scene/mesh/subdivision.h"

#include "renderer/core/error.h"
#include "renderer/core/parallel.h"
#include "renderer/scene/mesh/face_pattern.h"
#include "renderer/scene/mesh/limit_surface.h"
#include "renderer/scene/mesh/sharp_turns.h"
#include "renderer/scene/mesh/surface_frames.h"

#include <algorithm>
#include <fmt/format.h>
#include <memory>
#include <optional>
#include <span>

namespace rapport {
namespace {

/// Triangles around one vertex beyond which its faces stay flat: the cost of a limit surface grows
/// with the square of it, and no garment comes near.
constexpr uint32_t kMaxValence = 256;

constexpr size_t kFacesPerBatch = 64;

std::vector<char> faces_at_crowded_vertices(const IndexedMesh& mesh) {
    std::vector<uint32_t> valence(mesh.positions.size(), 0);
    for (const glm::uvec3& t : mesh.position_index)
        for (int c = 0; c < 3; ++c)
            ++valence[t[c]];
    std::vector<char> flat;
    flat.reserve(mesh.position_index.size());
    for (const glm::uvec3& t : mesh.position_index)
        flat.push_back(std::max({valence[t.x], valence[t.y], valence[t.z]}) > kMaxValence);
    return flat;
}

/// Gives mirrored faces UVs of their own, so that the UV map is cut where it folds back over
/// itself: a smooth map would stand still there and have no derivative. Returns how many there are.
size_t separate_mirrored_faces(IndexedMesh& mesh) {
    const auto offset = static_cast<uint32_t>(mesh.uvs.size());
    size_t mirrored = 0;
    for (size_t t = 0; t < mesh.uv_index.size(); ++t)
        if (has_mirrored_uvs(mesh, t)) {
            mesh.uv_index[t] += offset;
            ++mirrored;
        }
    if (mirrored > 0) {
        mesh.uvs.resize(2 * size_t{offset});
        std::copy_n(mesh.uvs.begin(), offset, mesh.uvs.begin() + offset);
        if (!mesh.warps.empty()) {
            mesh.warps.resize(2 * size_t{offset});
            std::copy_n(mesh.warps.begin(), offset, mesh.warps.begin() + offset);
        }
    }
    return mirrored;
}

/// The position of a vertex that lies on a cut, a pinned corner or a point of a straight side, with
/// the same bits in every piece that meets there; nothing where the limit surface decides.
std::optional<glm::dvec3> position_on_cut(const ControlMesh& control,
                                          const Tessellation::Vertex& v) {
    if (v.side == Tessellation::kInside)
        return std::nullopt;
    if (v.step == 0)
        return control.cut.pinned[control.vertex(v.side)] ? std::optional(control.position(v.side))
                                                          : std::nullopt;
    if (!control.cut.straight[v.side / 3][static_cast<int>(v.side % 3)])
        return std::nullopt;
    const double step = v.step, rate = v.rate;
    return ((rate - step) * control.position(v.side) + step * control.position(next_side(v.side))) /
           rate;
}

/// Limit points of all vertices. Triangles of faces that turn out to have no limit surface are
/// added to `flat`, and the result is then not valid.
std::vector<LimitPoint> limit_points(const ControlMesh& control, const LimitSurface* surface,
                                     const Tessellation& tessellation, std::vector<char>& flat) {
    std::vector<LimitPoint> points(tessellation.vertices.size());
    const size_t faces = control.faces.size();
    parallel_for((faces + kFacesPerBatch - 1) / kFacesPerBatch, [&](size_t batch) {
        std::vector<glm::vec2> parameters;
        const size_t end = std::min(faces, (batch + 1) * kFacesPerBatch);
        for (size_t number = batch * kFacesPerBatch; number < end; ++number) {
            const Face& face = control.faces[number];
            const size_t first = tessellation.first[number];
            const size_t count = tessellation.first[number + 1] - first;
            parameters.clear();
            for (size_t i = first; i < first + count; ++i)
                parameters.push_back(tessellation.vertices[i].parameter);
            const std::span<LimitPoint> out = std::span(points).subspan(first, count);
            if (control.detached[face.triangle()])
                for (size_t i = 0; i < count; ++i)
                    out[i] = flat_point(control.mesh, face.triangle(), parameters[i]);
            else if (!surface->evaluate(static_cast<uint32_t>(number), parameters, out))
                for (uint32_t i = 0; i < face.size; ++i)
                    flat[face.side[i] / 3] = 1;
            for (size_t i = 0; i < count; ++i)
                out[i].position = position_on_cut(control, tessellation.vertices[first + i])
                                      .value_or(out[i].position);
        }
    });
    return points;
}

/// Positions and normals from limit points; `result` has its triangles.
void fill_shape(TriangleMesh& result, const Tessellation& tessellation,
                const std::vector<LimitPoint>& points) {
    const size_t count = points.size();
    result.positions.resize(count);
    result.normals.resize(count);
    std::vector<char> has_normal(count, 1);
    for (size_t i = 0; i < count; ++i) {
        const LimitPoint& p = points[tessellation.vertices[i].normal];
        const glm::dvec3 normal = glm::cross(p.position_s, p.position_t);
        const double length = glm::length(normal);
        result.positions[i] = points[tessellation.vertices[i].place].position;
        has_normal[i] = length > 0 && std::isfinite(length);
        if (has_normal[i])
            result.normals[i] = normal / length;
    }
    // Where the surface is pinched to a line or point, the triangles around decide.
    if (std::find(has_normal.begin(), has_normal.end(), 0) != has_normal.end()) {
        const std::vector<glm::vec3> smooth = smooth_normals(result.positions, result.triangles);
        for (size_t i = 0; i < count; ++i)
            if (!has_normal[i])
                result.normals[i] = smooth[tessellation.vertices[i].normal];
    }
}

/// What the corners are given, interpolated over the face to which a vertex belongs.
template <class OfCorner>
auto given(const ControlMesh& control, const Tessellation::Vertex& vertex,
           const OfCorner& of_corner) {
    const Face& face = control.faces[vertex.face];
    const glm::dvec4 shares = corner_shares(control.kind(face), vertex.parameter);
    auto sum = shares[0] * of_corner(face.side[0]);
    for (uint32_t i = 1; i < face.size; ++i)
        sum += shares[static_cast<int>(i)] * of_corner(face.side[i]);
    return sum;
}

void fill_colors(TriangleMesh& result, const ControlMesh& control,
                 const Tessellation& tessellation) {
    result.colors.clear();
    for (const Tessellation::Vertex& vertex : tessellation.vertices)
        result.colors.emplace_back(given(control, vertex, [&](uint32_t side) {
            return glm::dvec4(control.mesh.colors[control.color(side)]);
        }));
}

/// UVs and frames. Returns the number of mended frames.
size_t fill_frames(TriangleMesh& result, const ControlMesh& control,
                   const Tessellation& tessellation, const std::vector<LimitPoint>& points) {
    const size_t count = points.size();
    result.uvs.resize(count);
    result.weft.resize(count);
    result.warp.resize(count);
    std::vector<char> sound(count);
    for (size_t i = 0; i < count; ++i) {
        const LimitPoint& p = points[i];
        const glm::dvec3 normal = result.normals[i];
        const WeftWarp frame =
            control.mesh.warps.empty()
                ? weft_warp(p.position_s, p.position_t, p.uv_s, p.uv_t, normal)
                : weft_across(given(control, tessellation.vertices[i],
                                    [&](uint32_t side) {
                                        return glm::dvec3(control.mesh.warps[control.uv(side)]);
                                    }),
                              normal);
        result.uvs[i] = p.uv;
        result.weft[i] = frame.weft;
        result.warp[i] = frame.warp;
        sound[i] = frame.sound;
    }
    return repair_frames(result, std::move(sound));
}

/// Cuts every edge into half as many pieces, rounded up; false if none can be cut less. Sides of
/// equal rates, as those of one edge have, stay equal.
bool halve(SideRates& rates) {
    bool fell = false;
    for (uint16_t& rate : rates) {
        fell |= rate > 1;
        rate = static_cast<uint16_t>((rate + 1) / 2);
    }
    return fell;
}

size_t count_creases(const ControlMesh& control) {
    size_t creases = 0;
    for_each_edge(control.edges, [&](std::span<const EdgeUse> edge) {
        creases += control.crease[3 * edge[0].triangle + edge[0].corner];
    });
    return creases;
}

} // namespace

EdgeRate uniform_rate(int level) {
    return [level](const glm::dvec3&, const glm::dvec3&) { return level; };
}

TriangleMesh subdivide(const CleanMesh& input, const SubdivisionOptions& options,
                       const std::string& name, SubdivisionReport* report) {
    const bool has_uvs = !input.uv_index.empty();
    if (options.need_uvs && !has_uvs)
        throw FileError(name, "", "UVs (TEXCOORD_0) for the cloth", "none");
    IndexedMesh mesh = input;
    SubdivisionReport counts;
    counts.mirrored = separate_mirrored_faces(mesh);
    std::vector<char> flat = faces_at_crowded_vertices(mesh);
    TriangleMesh result;
    for (bool complete = false; !complete;) {
        const ControlMesh control =
            make_control_mesh(mesh, flat, {options.crease_angle, options.quads});
        std::unique_ptr<const LimitSurface> surface;
        if (control.cut.attached_vertices > 0)
            surface = std::make_unique<LimitSurface>(control);
        SideRates rates = side_rates(control, options.rate);
        std::optional<Tessellation> tessellation;
        std::vector<LimitPoint> points;
        counts.coarser = 1;
        do {
            while (!(tessellation = tessellate(control, rates, options.max_triangles))) {
                if (!halve(rates))
                    throw FileError(name, "",
                                    fmt::format("at most {} triangles", options.max_triangles),
                                    "more");
                counts.coarser *= 2;
            }
            points = limit_points(control, surface.get(), *tessellation, flat);
            complete = flat == control.detached;
            if (!complete)
                break;
            result.triangles = tessellation->triangles;
            fill_shape(result, *tessellation, points);
        } while (options.finest_rate && counts.coarser == 1 &&
                 refine_sharp_turns(control, *tessellation, result, options.finest_rate, rates));
        if (!complete)
            continue;
        counts.non_manifold_edges = control.cut.non_manifold_edges;
        counts.bow_ties = control.cut.bow_ties;
        counts.t_junctions = control.t_junctions;
        counts.creases = count_creases(control);
        counts.quads = mesh.position_index.size() - control.faces.size();
        if (has_uvs)
            counts.frames_repaired = fill_frames(result, control, *tessellation, points);
        if (!mesh.color_index.empty())
            fill_colors(result, control, *tessellation);
    }
    if (options.need_uvs && counts.frames_repaired > 0 &&
        counts.frames_repaired == result.positions.size())
        throw FileError(name, "", "UVs (TEXCOORD_0) that cover an area", "none that do");

    counts.faces = mesh.position_index.size();
    counts.dropped = input.dropped.degenerate + input.dropped.repeated;
    counts.unrefinable = static_cast<size_t>(std::count(flat.begin(), flat.end(), 1));
    if (report)
        *report = counts;
    return result;
}

} // namespace rapport
