#include "renderer/core/error.h"
#include "renderer/scene/gltf.h"
#include "renderer/scene/shape.h"
#include "renderer/scene/subdivision.h"

#include <fmt/format.h>

namespace rapport {
namespace {

constexpr int kDefaultLevel = 3;
constexpr int kHighestLevel = 64;

void report(const SubdivisionReport& counts, const std::string& part,
            std::vector<std::string>& warnings) {
    for (const auto& [count, what] :
         {std::pair{counts.dropped, "triangles without area were dropped"},
          {counts.non_manifold_edges, "non-manifold edges were cut"},
          {counts.unrefinable, "faces could not be subdivided and stay flat"},
          {counts.mirrored, "faces have mirrored UVs: the cloth is not mirrored with them"},
          {counts.frames_repaired, "vertices took their warp direction from their neighbours"}})
        if (count > 0)
            warnings.push_back(fmt::format("{}: {} {}", part, count, what));
}

TriangleMesh refine(const GltfPart& part, int level, bool needs_uvs, const std::string& name,
                    std::vector<std::string>& warnings) {
    if (level == 0) {
        if (needs_uvs && part.mesh.uv_index.empty())
            throw FileError(name, "", "UVs, along which the cloth lies", "none");
        return flat_mesh(part.mesh);
    }
    SubdivisionReport counts;
    TriangleMesh mesh = subdivide(part.mesh, level, needs_uvs, name, &counts);
    report(counts, name, warnings);
    return mesh;
}

/// A glTF or GLB model, metres, in glTF's axes (+y up); one part per primitive.
///     "string filename"  required
///     "integer level"    each triangle of the file becomes level² on the limit surface of Loop's
///                        subdivision; 0 = the flat triangles as they are; default 3
std::vector<ShapePart> make_gltf(const ShapeContext& context) {
    const Params& params = context.params;
    const std::string filename = params.get_string("filename", "");
    if (filename.empty())
        params.fail("filename", "\"string filename\" of a .gltf or .glb", "none");
    const int level = params.get_int("level", kDefaultLevel);
    if (level < 0 || level > kHighestLevel)
        params.fail("level", fmt::format("a number from 0 to {}", kHighestLevel),
                    std::to_string(level));
    const std::filesystem::path path = context.base_dir / filename;
    const GltfModel model = read_gltf(path);
    for (const std::string& warning : model.warnings)
        context.warnings.push_back(fmt::format("{}: {}", path.string(), warning));
    std::vector<ShapePart> parts;
    for (const GltfPart& part : model.parts)
        parts.push_back({refine(part, level, context.needs_uvs(part.material),
                                fmt::format("{}: {}", path.string(), part.name), context.warnings),
                         part.material, part.base_color});
    return parts;
}

const Registered<ShapeFactory> registered("gltf", make_gltf);

} // namespace
} // namespace rapport
