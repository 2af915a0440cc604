#pragma once

#include "renderer/core/fresnel.h"
#include "renderer/core/rng.h"
#include "renderer/kernel/fibre_tracer.h"

#include <algorithm>
#include <span>
#include <vector>

namespace rapport {

/// Optics of one kind of fibre (FibreChain::kind).
struct FibreOptics {
    double refractive_index = 1.5;         ///< against air, at least 1; the same in all bands
    std::vector<double> absorption_per_um; ///< per band
    double surface_absorption = 0;         ///< share lost at each boundary event, [0, 1]
};

/// FibreOptics made ready for tracing: whatever dims light is an optical depth, so that the share
/// of light left in band b is exp(−Σ depth_b).
struct FibreMedium {
    double refractive_index;
    double surface_depth;                  ///< −ln(1 − surface absorption), infinite for 1
    std::vector<double> absorption_per_um; ///< per band
};

/// Throws std::invalid_argument for an index below 1, negative absorption, a surface absorption
/// outside [0, 1], another number of bands than `bands`, or a fibre whose kind has no optics.
std::vector<FibreMedium> fibre_media(std::span<const FibreOptics> optics, size_t bands,
                                     const kernel::FibreTracer& tracer);

/// Light on its way through the fibres.
struct FibreLight {
    glm::dvec3 position{}, direction{};            ///< unit direction of travel
    uint32_t segment = kernel::FibreTracer::kNone; ///< on whose surface it is, if any
    bool inside = false;                           ///< that segment's fibre
    bool scattered = false;                        ///< an event changed its direction
    uint32_t events = 0, overlaps = 0;
    std::vector<double> optical_depth; ///< per band
};

enum class FibreStep : uint8_t {
    event,  ///< it met a boundary, where it was reflected or refracted
    leaves, ///< it left the cloth
    lost,   ///< it travels within the cloth without meeting a fibre (FibreTracer::Flight::lost)
};

/// What becomes of the direction of light at a smooth dielectric boundary; `choice`, uniform in
/// [0, 1), decides between reflection and refraction by the Fresnel reflectance. `normal` is the
/// fibre's, outward; `inside` tells from which side the light comes. Index 1 changes nothing.
struct BoundaryEvent {
    glm::dvec3 direction;
    bool transmitted;
};
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

/// Takes light to the next boundary and through what happens there: the one event of which every
/// path through explicit fibres consists. Volume absorption (Beer–Lambert) dims it along the way,
/// surface absorption at the boundary. Where fibres overlap, light that leaves one inside another
/// is shifted back to the surface of the second and enters there (the paper, section 4).
inline FibreStep advance(const kernel::FibreTracer& tracer, std::span<const FibreMedium> media,
                         FibreLight& light, CounterRng& rng) {
    kernel::FibrePoint point;
    if (light.inside) {
        point = tracer.leave(light.position, light.direction, light.segment);
    } else {
        const kernel::FibreTracer::Entry entry =
            tracer.enter(light.position, light.direction, light.segment);
        if (entry.flight == kernel::FibreTracer::Flight::leaves)
            return FibreStep::leaves;
        if (entry.flight == kernel::FibreTracer::Flight::lost)
            return FibreStep::lost;
        light.overlaps += entry.overlap;
        point = entry.point;
    }
    const FibreMedium& medium = media[tracer.segments()[point.segment].kind];
    const double inside_length = light.inside ? point.distance : 0;
    for (size_t band = 0; band < light.optical_depth.size(); ++band)
        light.optical_depth[band] +=
            medium.absorption_per_um[band] * inside_length + medium.surface_depth;
    const BoundaryEvent event = meet_boundary(light.direction, point.normal, light.inside,
                                              medium.refractive_index, rng.uniform());
    light.position = point.position;
    light.direction = event.direction;
    light.segment = point.segment;
    light.inside = light.inside != event.transmitted;
    light.scattered = light.scattered || medium.refractive_index != 1;
    ++light.events;
    return FibreStep::event;
}

} // namespace rapport
