#include "renderer/core/error.h"
#include "renderer/scene/gltf/gltf.h"
#include "renderer/scene/mesh/auto_uvs.h"
#include "renderer/scene/mesh/subdivision.h"
#include "renderer/scene/shape/shape.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

namespace rapport {
namespace {

constexpr int kHighestLevel = 64;
/// Where facets make about the error that 64 samples a pixel leave as noise in a picture of 512²,
/// and less in larger ones (tests/bench/charts/tessellation.svg) [pixels].
constexpr float kDefaultEdgeLength = 4;
/// Into how many pieces an edge is cut at most, also right before the camera.
constexpr int kHighestRate = 256;
constexpr float kDefaultCreaseAngle = 30; ///< [degrees]

/// What was mended, in one line.
std::string summary(const CleaningReport& dropped, const SubdivisionReport& counts) {
    std::string line;
    for (const auto& [count, what] :
         {std::pair{dropped.degenerate, "triangles with two corners at one point dropped"},
          {dropped.repeated, "triangles that lie on another dropped"},
          {counts.non_manifold_edges, "non-manifold edges cut"},
          {counts.t_junctions, "vertices on other edges (T-junctions) held there"},
          {counts.unrefinable, "faces that cannot be subdivided left flat"},
          {counts.mirrored, "faces with mirrored UVs, with which the cloth is not mirrored"},
          {counts.frames_repaired, "vertices given the warp direction of their neighbours"}})
        if (count > 0)
            line += fmt::format("{}{} {}", line.empty() ? "" : "; ", count, what);
    return line;
}

/// How finely edges are cut: "integer level" pieces each, or as "float edgelength" asks.
EdgeRate edge_rate(const ShapeContext& context) {
    const Params& params = context.params;
    const float pixels = params.get_float("edgelength", kDefaultEdgeLength);
    if (!(pixels > 0))
        params.fail("edgelength", "a length above 0 pixels", fmt::format("{}", pixels));
    if (!params.has("level"))
        return [seen = context.seen_length, pixels](const glm::dvec3& a, const glm::dvec3& b) {
            const double pieces = std::ceil(seen(a, b) / pixels); // infinite at the camera
            return static_cast<int>(std::clamp(pieces, 1.0, double{kHighestRate}));
        };
    if (params.has("edgelength"))
        params.fail("level", "either level or edgelength", "both");
    const int level = params.get_int("level", 0);
    if (level < 0 || level > kHighestLevel)
        params.fail("level", fmt::format("a number from 0 to {}", kHighestLevel),
                    std::to_string(level));
    return uniform_rate(level);
}

SubdivisionOptions subdivision(const ShapeContext& context) {
    SubdivisionOptions options;
    options.rate = edge_rate(context);
    const float angle = context.params.get_float("creaseangle", kDefaultCreaseAngle);
    if (!(angle >= 0 && angle <= 180))
        context.params.fail("creaseangle", "an angle from 0 to 180 degrees",
                            fmt::format("{}", angle));
    options.crease_angle = radians(double{angle});
    options.quads = context.params.get_bool("quads", false);
    return options;
}

TriangleMesh refine(const GltfPart& part, const SubdivisionOptions& options, bool flat,
                    const std::string& name, std::vector<std::string>& warnings) {
    if (flat && options.need_uvs && part.mesh.uv_index.empty())
        throw FileError(name, "", "UVs, along which the cloth lies", "none");
    SubdivisionReport counts;
    TriangleMesh mesh = flat ? flat_mesh(part.mesh) : subdivide(part.mesh, options, name, &counts);
    if (const std::string mended = summary(part.dropped, counts); !mended.empty())
        warnings.push_back(fmt::format("{}: {}", name, mended));
    return mesh;
}

/// A glTF or GLB model, metres, in glTF's axes (+y up); one part per primitive, subdivided.
///     "string filename"   required
///     "float edgelength"  edges are cut into pieces that are seen under this many pixels at most,
///                         if they stand square to the view; default 4
///     "integer level"     instead, each edge is cut into so many; 0 = the triangles as they are
///     "float creaseangle" edges where the file's normals differ by more stay sharp [degrees];
///                         default 30
///     "bool quads"        joins pairs of triangles that were quads before they were exported, and
///                         subdivides by Catmull & Clark's rules instead of Loop's; default false
///     "bool autouv"       gives parts without UVs some (auto_uvs.h), so that a cloth can lie on
///     them;
///                         default false: it is an error there
std::vector<ShapePart> make_gltf(const ShapeContext& context) {
    const Params& params = context.params;
    const std::string filename = params.get_string("filename", "");
    if (filename.empty())
        params.fail("filename", "\"string filename\" of a .gltf or .glb", "none");
    SubdivisionOptions options = subdivision(context);
    const bool auto_uvs = params.get_bool("autouv", false);
    const bool flat = params.has("level") && params.get_int("level", 0) == 0;
    const std::filesystem::path path = context.base_dir / filename;
    GltfModel model = read_gltf(path);
    for (const std::string& warning : model.warnings)
        context.warnings.push_back(fmt::format("{}: {}", path.string(), warning));
    std::vector<ShapePart> parts;
    for (GltfPart& part : model.parts) {
        if (auto_uvs && part.mesh.uv_index.empty()) {
            add_auto_uvs(part.mesh);
            part.base_color.picture = nullptr; // it was not made for these
        }
        options.need_uvs = context.needs_uvs(part.material);
        parts.push_back({refine(part, options, flat,
                                fmt::format("{}: {}", path.string(), part.name), context.warnings),
                         part.material, part.base_color});
    }
    return parts;
}

const Registered<ShapeFactory> registered("gltf", make_gltf);

} // namespace
} // namespace rapport
