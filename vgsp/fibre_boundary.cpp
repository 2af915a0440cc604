#include "vgsp/fibre_boundary.h"

namespace rapport {
namespace {

// Directions here are in the frame of the boundary, z towards the side that the light is on. How
// deep the light is among the facets is told by −ln of the share of the microsurface that lies
// below it, so that an upward flight meets facets at the constant rate Λ per unit of depth, and a
// downward one at 1 + Λ, whatever the distribution of heights (Heitz et al. 2016, section 4).

constexpr double kDeepest = 100; ///< but for a share of e^−100 all of the microsurface lies above

/// Of index 1.53 and width 1 one path in 200 000 meets more than 16. Only along the horizon of an
/// index so near to 1 that facets hardly deflect are there ever more than this: there light then
/// leaves as it goes, or mirrored.
constexpr int kMostFacets = 1000;

/// Smith's Λ of the directions ±w.
double smith_lambda(const glm::dvec3& w, double roughness) {
    const double stretched = std::sqrt(square(w.z) + square(roughness) * (w.x * w.x + w.y * w.y));
    return std::max(0.0, 0.5 * (stretched / std::abs(w.z) - 1));
}

/// The normal of a facet that is seen from `view`, which may lie below the horizon, in proportion
/// to the area that is seen of it: normals of a hemisphere are seen where those that mirror `view`
/// fill a spherical cap evenly (J. Dupuy, A. Benyoub, "Sampling Visible GGX Normals with Spherical
/// Caps", 2023).
glm::dvec3 visible_normal(const glm::dvec3& view, double roughness, double u, double v) {
    const glm::dvec3 stretch(roughness, roughness, 1);
    const glm::dvec3 seen_from = glm::normalize(stretch * view);
    const double z = 1 - v * (1 + seen_from.z), across = safe_sqrt(1 - z * z), phi = 2 * kPi * u;
    const glm::dvec3 mirrored(across * std::cos(phi), across * std::sin(phi), z);
    return glm::normalize(stretch * (seen_from + mirrored));
}

} // namespace

BoundaryEvent meet_rough_boundary(const glm::dvec3& direction, const glm::dvec3& normal,
                                  bool inside, double refractive_index, double roughness,
                                  CounterRng& rng) {
    if (refractive_index == 1)
        return {direction, true};
    const auto frame = BasicFrame<double>::about(inside ? -normal : normal);
    glm::dvec3 w = frame.to_local(direction);
    w.z = std::min(w.z, 0.0); // rounding may have it leave before it came
    double depth = 0;
    bool transmitted = false;
    for (int facets = 0; facets < kMostFacets; ++facets) {
        const double flight = -std::log(rng.uniform()), lambda = smith_lambda(w, roughness);
        depth += w.z > 0 ? -flight / lambda : flight / (1 + lambda);
        if (depth <= 0)
            break;
        const double u = rng.uniform(), v = rng.uniform();
        const glm::dvec3 facet = visible_normal(-w, roughness, u, v);
        const BoundaryEvent event =
            meet_boundary(w, inside ? -facet : facet, inside, refractive_index, rng.uniform());
        w = event.direction;
        if (event.transmitted) { // seen from its other side, what lay above lies below
            w.z = -w.z;
            depth = std::min(-std::log(-std::expm1(-depth)), kDeepest);
            inside = !inside;
            transmitted = !transmitted;
        }
    }
    const double z = std::abs(w.z); // already upwards, unless the facets ran out
    return {frame.to_world({w.x, w.y, transmitted ? -z : z}), transmitted};
}

} // namespace rapport
