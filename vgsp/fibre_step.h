#pragma once

#include "renderer/kernel/fibre_tracer.h"
#include "vgsp/fibre_boundary.h"

#include <span>
#include <vector>

namespace rapport {

/// Optics of one kind of fibre (FibreChain::kind).
struct FibreOptics {
    double refractive_index = 1.5;         ///< against air, at least 1; the same in all bands
    std::vector<double> absorption_per_um; ///< per band
    double surface_absorption = 0;         ///< share lost at each boundary event, [0, 1]
    double roughness = 0;                  ///< of the surface, see meet_rough_boundary()
};

/// FibreOptics made ready for tracing: whatever dims light is an optical depth, so that the share
/// of light left in band b is exp(−Σ depth_b).
struct FibreMedium {
    double refractive_index;
    double surface_depth;                  ///< −ln(1 − surface absorption), infinite for 1
    std::vector<double> absorption_per_um; ///< per band
    double roughness;
};

/// Throws std::invalid_argument for an index below 1, negative absorption, a surface absorption
/// or roughness outside [0, 1], another number of bands than `bands`, or a fibre whose kind has no
/// optics.
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
    const BoundaryEvent event =
        medium.roughness < kLeastRoughness
            ? meet_boundary(light.direction, point.normal, light.inside, medium.refractive_index,
                            rng.uniform())
            : meet_rough_boundary(light.direction, point.normal, light.inside,
                                  medium.refractive_index, medium.roughness, rng);
    light.position = point.position;
    light.direction = event.direction;
    light.segment = point.segment;
    light.inside = light.inside != event.transmitted;
    light.scattered = light.scattered || medium.refractive_index != 1;
    ++light.events;
    return FibreStep::event;
}

} // namespace rapport
