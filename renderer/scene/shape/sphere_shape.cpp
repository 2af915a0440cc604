#include "renderer/scene/mesh/surface_grid.h"

#include <fmt/format.h>

namespace rapport {
namespace {

/// A sphere about the origin, or the part of it between two heights and up to an azimuth; a mesh
/// whose outline is true to a twentieth of a pixel.
///     "float radius"        default 1
///     "float zmin", "zmax"  default the whole
///     "float phimax"        [degrees]; default 360
/// As in pbrt, u grows with the azimuth and v from zmin to zmax.
std::vector<ShapePart> make_sphere(const ShapeContext& context) {
    const Params& params = context.params;
    const float radius = params.get_float("radius", 1);
    if (!(radius > 0))
        params.fail("radius", "a radius above 0", fmt::format("{}", radius));
    const float low = std::clamp(params.get_float("zmin", -radius), -radius, radius);
    const float high = std::clamp(params.get_float("zmax", radius), -radius, radius);
    if (!(low < high))
        params.fail("zmin", "heights with zmin below zmax", fmt::format("{} and {}", low, high));
    const double phi_max = radians(double{params.get_float("phimax", 360)});
    if (!(phi_max > 0 && phi_max <= 2 * kPi))
        params.fail("phimax", "an angle above 0, to 360 degrees",
                    fmt::format("{}", degrees(phi_max)));
    const double theta_low = std::acos(double{low} / radius);
    const double theta_high = std::acos(double{high} / radius);
    const int pieces = circle_pieces(context, {0, 0, 0}, radius);
    TriangleMesh mesh = surface_grid(pieces, pieces / 2, [&](const glm::vec2& uv) {
        const double phi = uv.x < 1 || phi_max < 2 * kPi ? uv.x * phi_max : 0; // closed exactly
        const double theta = theta_low + uv.y * (theta_high - theta_low);
        const double sine = theta <= 0 || theta >= kPi ? 0 : std::sin(theta);
        const glm::dvec3 out(sine * std::cos(phi), sine * std::sin(phi), std::cos(theta));
        const glm::dvec3 weft(-std::sin(phi), std::cos(phi), 0);
        return GridPoint{double{radius} * out, out, weft, glm::cross(out, weft)};
    });
    return {{std::move(mesh), ""}};
}

const Registered<ShapeFactory> registered("sphere", make_sphere);

} // namespace
} // namespace rapport
