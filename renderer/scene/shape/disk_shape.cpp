#include "renderer/scene/mesh/surface_grid.h"

#include <fmt/format.h>

namespace rapport {
namespace {

/// A disk square to the z axis, face up; a mesh whose outline is true to a twentieth of a pixel.
///     "float radius"       default 1
///     "float innerradius"  of the hole; default 0
///     "float height"       its z; default 0
///     "float phimax"       [degrees]; default 360
/// As in pbrt, u grows with the azimuth and v from the rim to the middle.
std::vector<ShapePart> make_disk(const ShapeContext& context) {
    const Params& params = context.params;
    const float radius = params.get_float("radius", 1), inner = params.get_float("innerradius", 0);
    if (!(inner >= 0 && inner < radius))
        params.fail("radius", "a radius above that of the hole, which is 0 or more",
                    fmt::format("{} and {}", radius, inner));
    const float height = params.get_float("height", 0);
    const double phi_max = radians(double{params.get_float("phimax", 360)});
    if (!(phi_max > 0 && phi_max <= 2 * kPi))
        params.fail("phimax", "an angle above 0, to 360 degrees",
                    fmt::format("{}", degrees(phi_max)));
    const int pieces = circle_pieces(context, {0, 0, height}, radius);
    TriangleMesh mesh = surface_grid(pieces, 1, [&](const glm::vec2& uv) {
        const double phi = uv.x < 1 || phi_max < 2 * kPi ? uv.x * phi_max : 0; // closed exactly
        const glm::dvec3 out(std::cos(phi), std::sin(phi), 0);
        const double r = radius + uv.y * (double{inner} - radius);
        return GridPoint{r * out + glm::dvec3(0, 0, height), glm::vec3(0, 0, 1),
                         glm::dvec3(-out.y, out.x, 0), -out};
    });
    return {{std::move(mesh), ""}};
}

const Registered<ShapeFactory> registered("disk", make_disk);

} // namespace
} // namespace rapport
