#include "vgsp/fibre_step.h"

#include <stdexcept>

namespace rapport {
namespace {

void add_dye(FibreMedium& medium, const std::vector<double>& absorption_per_um, size_t bands) {
    if (absorption_per_um.size() != bands)
        throw std::invalid_argument("a fibre's absorption is not given once per band");
    for (const double absorption : absorption_per_um) {
        if (!(absorption >= 0) || !std::isfinite(absorption))
            throw std::invalid_argument("a fibre's absorption is negative");
        medium.absorption_per_um.push_back(absorption);
    }
}

} // namespace

std::vector<FibreMedium> fibre_media(std::span<const FibreOptics> optics, size_t bands,
                                     const kernel::FibreTracer& tracer,
                                     const Colourways& colourways) {
    std::vector<FibreMedium> media;
    for (const FibreOptics& kind : optics) {
        if (!(kind.refractive_index >= 1) || !std::isfinite(kind.refractive_index))
            throw std::invalid_argument("a fibre's refractive index is below 1");
        if (!(kind.surface_absorption >= 0 && kind.surface_absorption <= 1))
            throw std::invalid_argument("a fibre's surface absorption is outside [0, 1]");
        if (!(kind.roughness >= 0 && kind.roughness <= 1))
            throw std::invalid_argument("a fibre's roughness is outside [0, 1]");
        media.push_back(
            {kind.refractive_index, -std::log1p(-kind.surface_absorption), {}, kind.roughness});
        add_dye(media.back(), kind.absorption_per_um, bands);
    }
    for (const auto& [name, dyes] : colourways) {
        if (dyes.size() != media.size())
            throw std::invalid_argument("a colourway has not one dye for each kind of fibre");
        for (size_t kind = 0; kind < dyes.size(); ++kind)
            add_dye(media[kind], dyes[kind], bands);
    }
    for (const kernel::FibreSegment& segment : tracer.segments())
        if (segment.kind >= media.size())
            throw std::invalid_argument("a fibre's kind has no optics");
    return media;
}

} // namespace rapport
