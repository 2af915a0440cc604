#pragma once

#include "renderer/core/fresnel.h"
#include "renderer/core/math.h"
#include "renderer/core/rng.h"

#include <algorithm>

namespace rapport {

/// What becomes of light at a boundary.
struct BoundaryEvent {
    glm::dvec3 direction; ///< of travel, unit
    bool transmitted;
};

/// At a smooth dielectric boundary; `choice`, uniform in [0, 1), decides between reflection and
/// refraction by the Fresnel reflectance. `normal` is the fibre's, outward; `inside` tells from
/// which side the light comes. Index 1 changes nothing.
inline BoundaryEvent meet_boundary(const glm::dvec3& direction, const glm::dvec3& normal,
                                   bool inside, double refractive_index, double choice) {
    if (refractive_index == 1)
        return {direction, true};
    const double eta = inside ? refractive_index : 1 / refractive_index;
    const glm::dvec3 facing = inside ? -normal : normal;
    const double cos_incident = std::clamp(-glm::dot(direction, facing), 0.0, 1.0);
    const FresnelResult fresnel = fresnel_dielectric(cos_incident, eta);
    if (choice < fresnel.reflectance)
        return {glm::normalize(direction + facing * (2 * cos_incident)), false};
    return {
        glm::normalize(direction * eta + facing * (eta * cos_incident - fresnel.cos_transmitted)),
        true};
}

/// The roughness of a boundary is 0 (smooth) or in [kLeastRoughness, 1]: deflections by less are
/// lost in rounding.
inline constexpr double kLeastRoughness = 1e-6;

/// At a rough dielectric boundary: a microsurface of smooth facets whose normals have the
/// Trowbridge–Reitz (GGX) distribution of width α = `roughness`, and whose heights are independent
/// of them and of each other (Smith's model). The light goes from facet to facet, reflected or
/// refracted at each, until it leaves to either side (E. Heitz, J. Hanika, E. d'Eon, C.
/// Dachsbacher, "Multiple-Scattering Microfacet BSDFs with the Smith Model", 2016). So no light is
/// lost however rough the boundary is, and light obeys reciprocity: seen from both sides, a
/// boundary in a field of equal radiance per n² leaves it as it is. As roughness falls to 0 this
/// becomes meet_boundary(). The microsurface has no extent: light leaves where it came.
BoundaryEvent meet_rough_boundary(const glm::dvec3& direction, const glm::dvec3& normal,
                                  bool inside, double refractive_index, double roughness,
                                  CounterRng& rng);

} // namespace rapport
