#pragma once

#include "renderer/kernel/fibre_tracer.h"
#include "vgsp/fibre_boundary.h"
#include "vgsp/per_band.h"

#include <map>
#include <span>
#include <string>
#include <vector>

namespace rapport {

/// Optics of one kind of fibre (FibreChain::kind).
struct FibreOptics {
    PerBand refractive_index = 1.5;        ///< against air, at least 1
    std::vector<double> absorption_per_um; ///< per band
    double surface_absorption = 0;         ///< share lost at each boundary event, [0, 1]
    double roughness = 0;                  ///< of the surface, see meet_rough_boundary()
};

/// Other dyes for the same fibres: by name of the set, volume absorption [1/µm] per kind and band.
using Colourways = std::map<std::string, std::vector<std::vector<double>>>;

/// FibreOptics made ready for tracing. Dyes only dim a path, so that all of them share it: a
/// channel is a band in one set of dyes, first those of FibreOptics, then the colourways.
struct FibreMedium {
    double refractive_index;
    double surface_depth;                  ///< −ln(1 − surface absorption), infinite for 1
    std::vector<double> absorption_per_um; ///< per channel: [set of dyes, band]
    double roughness;
};

/// Whether an index differs between bands, which then take different paths.
bool disperses(std::span<const FibreOptics> optics);
/// The same fibres in one band alone.
std::vector<FibreOptics> in_band(std::span<const FibreOptics> optics, size_t band);

/// Of fibres that do not disperse.
///
/// Throws std::invalid_argument for an index below 1, negative absorption, a surface absorption
/// or roughness outside [0, 1], another number of bands than `bands` or of kinds than `optics`, or
/// a fibre whose kind has no optics.
std::vector<FibreMedium> fibre_media(std::span<const FibreOptics> optics, size_t bands,
                                     const kernel::FibreTracer& tracer,
                                     const Colourways& colourways = {});
/// For each group of bands that share paths: of all bands, or of each if the fibres disperse.
std::vector<std::vector<FibreMedium>> media_of_groups(std::span<const FibreOptics> optics,
                                                      size_t bands,
                                                      const kernel::FibreTracer& tracer,
                                                      const Colourways& colourways = {});

/// Light on its way through the fibres.
struct FibreLight {
    glm::dvec3 position{}, direction{};            ///< unit direction of travel
    glm::dvec3 travelled{};                        ///< from its start: periods do not cut it short
    uint32_t segment = kernel::FibreTracer::kNone; ///< on whose surface it is, if any
    bool inside = false;                           ///< that segment's fibre
    bool scattered = false;                        ///< an event changed its direction
    uint32_t events = 0, overlaps = 0;
    double surface_depth = 0;   ///< optical depth of the boundaries it met
    std::vector<double> length; ///< travelled inside fibres of each kind [µm]
};

/// Optical depth of the light's way in each channel: the share exp(−depth) is left of it, by
/// Beer–Lambert within the fibres and by what their surfaces took.
inline void optical_depths(const FibreLight& light, std::span<const FibreMedium> media,
                           std::span<double> depths) {
    std::ranges::fill(depths, light.surface_depth);
    for (size_t kind = 0; kind < media.size(); ++kind)
        for (size_t channel = 0; channel < depths.size(); ++channel)
            depths[channel] += media[kind].absorption_per_um[channel] * light.length[kind];
}

enum class FibreStep : uint8_t {
    event,  ///< it met a boundary, where it was reflected or refracted
    leaves, ///< it left the cloth
    lost,   ///< it travels within the cloth without meeting a fibre (FibreTracer::Flight::lost)
};

/// Takes light to the next boundary and through what happens there: the one event of which every
/// path through explicit fibres consists. Where fibres overlap, light that leaves one inside
/// another is shifted back to the surface of the second and enters there (the paper, section 4).
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
    const uint32_t kind = tracer.segments()[point.segment].kind;
    const FibreMedium& medium = media[kind];
    if (light.inside)
        light.length[kind] += point.distance;
    light.travelled += light.direction * point.distance;
    light.surface_depth += medium.surface_depth;
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
