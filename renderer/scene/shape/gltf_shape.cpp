#include "renderer/core/error.h"
#include "renderer/scene/gltf/gltf.h"
#include "renderer/scene/mesh/auto_uvs.h"
#include "renderer/scene/mesh/strain.h"
#include "renderer/scene/mesh/subdivision.h"
#include "renderer/scene/mesh/uv_scale.h"
#include "renderer/scene/shape/shape.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <optional>

namespace rapport {
namespace {

constexpr int kHighestLevel = 64;
/// Between what a garment framed whole asks for and what is close up: 4, 3 and 2 pixels err by 4.2,
/// 3.2 and 2.1 % of the one, in a satin of sharp highlights, where 64 samples leave 1.8 % of noise,
/// and by 0.5, 0.4 and 0.2 % of the other in 0.43, 0.74 and 1.6 million triangles
/// (tests/bench/tessellation_bench.cpp, drawn in charts/tessellation.svg) [pixels].
constexpr float kDefaultEdgeLength = 3;
/// Into how many pieces an edge is cut at most, also right before the camera.
constexpr int kHighestRate = 256;
constexpr float kDefaultCreaseAngle = 30; ///< [degrees]
/// Where the surface turns sharply, edges are cut down to this length [pixels].
constexpr float kShortestEdge = 0.5f;
/// Strain that is told: lengths by more than this factor, angles by more than this [rad].
constexpr double kNotableStretch = 1.1, kNotableShear = radians(10.0);

/// What was mended, in one line.
std::string summary(const CleaningReport& dropped, const SubdivisionReport& counts,
                    size_t max_triangles) {
    std::string line;
    for (const auto& [count, what] :
         {std::pair{dropped.degenerate, "triangles with two corners at one point dropped"},
          {dropped.repeated, "triangles that lie on another dropped"},
          {dropped.vertices, "repeated vertices merged"},
          {dropped.collinear, "triangles without area, three corners on a line, left in place"},
          {counts.non_manifold_edges, "non-manifold edges cut"},
          {counts.bow_ties, "vertices where pieces meet in a point (bow-ties) cut"},
          {counts.t_junctions, "vertices on other edges (T-junctions) held there"},
          {counts.unrefinable, "faces that cannot be subdivided left flat"},
          {counts.mirrored, "faces with mirrored UVs, with which the cloth is not mirrored"},
          {counts.frames_repaired, "vertices given the warp direction of their neighbours"}})
        if (count > 0)
            line += fmt::format("{}{} {}", line.empty() ? "" : "; ", count, what);
    if (counts.coarser > 1)
        line += fmt::format("{}edges cut {} times less finely than asked, lest there be more than "
                            "{} triangles",
                            line.empty() ? "" : "; ", counts.coarser, max_triangles);
    return line;
}

/// As many pieces as make each be seen under so many pixels at most.
EdgeRate rate_by_sight(const ShapeContext& context, float pixels) {
    return [seen = context.seen_length, pixels](const glm::dvec3& a, const glm::dvec3& b) {
        const double pieces = std::ceil(seen(a, b) / pixels); // infinite at the camera
        return static_cast<int>(std::clamp(pieces, 1.0, double{kHighestRate}));
    };
}

/// How finely edges are cut: "integer level" pieces each, or as "float edgelength" asks.
void set_rates(const ShapeContext& context, SubdivisionOptions& options) {
    const Params& params = context.params;
    const float pixels = params.get_float("edgelength", kDefaultEdgeLength);
    if (!(pixels > 0))
        params.fail("edgelength", "a length above 0 pixels", fmt::format("{}", pixels));
    if (!params.has("level")) {
        options.rate = rate_by_sight(context, pixels);
        options.finest_rate = rate_by_sight(context, kShortestEdge);
        return;
    }
    if (params.has("edgelength"))
        params.fail("level", "either level or edgelength", "both");
    const int level = params.get_int("level", 0);
    if (level < 0 || level > kHighestLevel)
        params.fail("level", fmt::format("a number from 0 to {}", kHighestLevel),
                    std::to_string(level));
    options.rate = uniform_rate(level);
}

SubdivisionOptions subdivision(const ShapeContext& context) {
    SubdivisionOptions options;
    set_rates(context, options);
    const float angle = context.params.get_float("creaseangle", kDefaultCreaseAngle);
    if (!(angle >= 0 && angle <= 180))
        context.params.fail("creaseangle", "an angle from 0 to 180 degrees",
                            fmt::format("{}", angle));
    options.crease_angle = radians(double{angle});
    options.quads = context.params.get_bool("quads", false);
    return options;
}

/// Metres of cloth to a unit of UV, if the scene says so.
std::optional<double> stated_uv_scale(const Params& params) {
    if (params.is_string("uvscale")) {
        if (const std::string word = params.get_string("uvscale", ""); word != "auto")
            params.fail("uvscale", "a length [m] or \"auto\"", fmt::format("\"{}\"", word));
        return std::nullopt;
    }
    const double scale = params.get_float("uvscale", 1);
    if (!params.has("uvscale"))
        return std::nullopt;
    if (!(scale > 0))
        params.fail("uvscale", "a length above 0 m", fmt::format("{}", scale));
    return scale;
}

/// How the cloth is strained where it lies on a part, in words; nothing where that is little, and
/// nobody has asked.
std::string strain_told(const std::optional<double>& stated_scale, const IndexedMesh& part,
                        const TriangleMesh& mesh) {
    const double scale = stated_scale.value_or(metres_per_uv(part));
    if (!(scale > 0))
        return "";
    const Strain found = strain(mesh, scale);
    const auto is_notable = [](const Strain::Range& range) {
        return range.high > kNotableStretch || range.low * kNotableStretch < 1;
    };
    const double shear = std::max(-found.shear.low, found.shear.high);
    if (!stated_scale && !is_notable(found.weft) && !is_notable(found.warp) &&
        shear < kNotableShear)
        return "";
    return fmt::format("with {:.3g} m to a unit of UV the cloth lies stretched by {:.2f} to {:.2f} "
                       "along the weft and {:.2f} to {:.2f} along the warp, sheared by {:.0f}° to "
                       "{:.0f}°, in 90 % of its area",
                       scale, found.weft.low, found.weft.high, found.warp.low, found.warp.high,
                       degrees(found.shear.low), degrees(found.shear.high));
}

TriangleMesh refine(const CleanMesh& part, const ShapeContext& context,
                    const SubdivisionOptions& options, const std::string& name) {
    const bool flat = context.params.has("level") && context.params.get_int("level", 0) == 0;
    const bool by_tangents = context.params.get_bool("tangents", false);
    if (flat && options.need_uvs && part.uv_index.empty())
        throw FileError(name, "", "UVs, along which the cloth lies", "none");
    SubdivisionReport counts;
    TriangleMesh mesh = flat ? flat_mesh(part, &counts) : subdivide(part, options, name, &counts);
    if (options.need_uvs && by_tangents && part.warps.empty())
        throw FileError(name, "", "TANGENT and NORMAL attributes, along which the cloth lies",
                        "none");
    std::vector<std::string> told{summary(part.dropped, counts, options.max_triangles)};
    if (options.need_uvs && !by_tangents)
        told.push_back(strain_told(stated_uv_scale(context.params), part, mesh));
    for (const std::string& line : told)
        if (!line.empty())
            context.warnings.push_back(fmt::format("{}: {}", name, line));
    return mesh;
}

/// A glTF or GLB model, metres, in glTF's axes (+y up); one part per primitive, subdivided. Parts
/// for which the scene states no material are diffuse, in the base colour of their own, with its
/// picture, the colours of their vertices (COLOR_0), and what the alpha of these cuts out or lets
/// light through (alphaMode).
///     "string filename"   required
///     "float edgelength"  edges are cut into pieces that are seen under this many pixels at most,
///                         if they stand square to the view; default 3. Out of the picture pieces
///                         are eight times as long
///     "integer level"     instead, each edge is cut into so many; 0 = the triangles as they are
///     "float creaseangle" edges where the file's normals differ by more stay sharp [degrees];
///                         default 30
///     "bool quads"        joins pairs of triangles that were quads before they were exported, and
///                         subdivides by Catmull & Clark's rules instead of Loop's; default false
///     "bool autouv"       gives parts without UVs some (auto_uvs.h), so that a cloth can lie on
///                         them; default false: it is an error there
///     "bool tangents"     warp and weft follow the file's TANGENT and NORMAL attributes instead of
///                         the UVs: weft along the tangent, warp along the bitangent; default false
///     "float uvscale"     metres of cloth to a unit of UV: how the cloth is strained on the model
///                         is told by it. A measured cloth looks the same at any scale, so it
///                         changes no picture. Default, or `"string uvscale" "auto"`: what the
///                         cloth is least strained by, as `rapport info` tells it; strain is then
///                         told where it is more than a tenth, or 10° of shear
std::vector<ShapePart> make_gltf(const ShapeContext& context) {
    const Params& params = context.params;
    const std::string filename = params.get_string("filename", "");
    if (filename.empty())
        params.fail("filename", "\"string filename\" of a .gltf or .glb", "none");
    SubdivisionOptions options = subdivision(context);
    const bool auto_uvs = params.get_bool("autouv", false);
    const bool tangents = params.get_bool("tangents", false);
    stated_uv_scale(params); // refuses a bad one, whether a part wears a cloth or not
    const std::filesystem::path path = context.base_dir / filename;
    const auto model = context.model && !tangents
                           ? context.model
                           : std::make_shared<const GltfModel>(read_gltf(path, tangents));
    for (const std::string& warning : model->warnings)
        context.warnings.push_back(fmt::format("{}: {}", path.string(), warning));
    std::vector<ShapePart> parts;
    for (const GltfPart& part : model->parts) {
        options.need_uvs = context.needs_uvs(part.material);
        const std::string name = fmt::format("{}: {}", path.string(), part.name);
        BaseColor base_color = part.base_color;
        if (auto_uvs && part.mesh.uv_index.empty()) {
            IndexedMesh mesh = part.mesh;
            add_auto_uvs(mesh);
            CleanMesh merged(std::move(mesh));
            merged.dropped = part.mesh.dropped;
            base_color.picture = nullptr; // it was not made for these
            parts.push_back({refine(merged, context, options, name), part.material, base_color});
        } else {
            parts.push_back({refine(part.mesh, context, options, name), part.material, base_color});
        }
    }
    return parts;
}

const Registered<ShapeFactory> registered("gltf", make_gltf);

} // namespace
} // namespace rapport
