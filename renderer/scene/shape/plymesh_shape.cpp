#include "renderer/scene/mesh/ply.h"
#include "renderer/scene/shape/shape.h"

namespace rapport {
namespace {

/// A mesh in a PLY file.
///     "string filename"  required
std::vector<ShapePart> make_plymesh(const ShapeContext& context) {
    const std::string filename = context.params.get_string("filename", "");
    if (filename.empty())
        context.params.fail("filename", "\"string filename\" of a .ply", "none");
    return {{read_ply(context.base_dir / filename), ""}};
}

const Registered<ShapeFactory> registered("plymesh", make_plymesh);

} // namespace
} // namespace rapport
