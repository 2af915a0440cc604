#include "renderer/scene/mesh/mesh_operations.h"
#include "renderer/scene/shape/fibre_swatch.h"
#include "renderer/scene/shape/shape.h"

#include <fmt/format.h>

namespace rapport {
namespace {

/// A rectangle of cloth as its fibres themselves: weft along +x, warp along +y, face towards +z,
/// centred on the origin. Its own transform may turn, move and scale it, no more; the current
/// material is left aside.
///     "string filename"  a cloth `.toml`, or a draft `.wif` in the built-in viscose; required
///     "string colourway" in which of the cloth's dyes; default its own
///     "float width"      along the weft [m]; default 0.01
///     "float height"     along the warp [m]; default the width
///     "integer seed"     of the fibres; default 0
std::vector<ShapePart> make_fibers(const ShapeContext& context) {
    const Params& params = context.params;
    const std::string filename = params.get_string("filename", "");
    if (filename.empty())
        params.fail("filename", "\"string filename\" of a cloth .toml or .wif", "none");
    const std::filesystem::path path = context.base_dir / filename;
    const float width = params.get_float("width", 0.01f);
    const float height = params.get_float("height", width);
    for (const auto& [name, size] : {std::pair("width", width), {"height", height}})
        if (!(size > 0 && size <= 100))
            params.fail(name, "metres above 0, at most 100", fmt::format("{}", size));
    const int seed = params.get_int("seed", 0);
    if (seed < 0)
        params.fail("seed", "a number from 0", std::to_string(seed));

    const auto swatch =
        std::make_shared<const FibreSwatch>(load_cloth(path), 1e6 * glm::dvec2(width, height),
                                            params.get_string("colourway", ""), seed);
    return {{box(1e-6 * swatch->low(), 1e-6 * swatch->high()), "", {}, swatch}};
}

const Registered<ShapeFactory> registered("fibers", make_fibers);

} // namespace
} // namespace rapport
