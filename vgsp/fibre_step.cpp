#include "vgsp/fibre_step.h"

#include <algorithm>
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

bool disperses(std::span<const FibreOptics> optics) {
    return std::ranges::any_of(
        optics, [](const FibreOptics& kind) { return kind.refractive_index.differs(); });
}

std::vector<FibreOptics> in_band(std::span<const FibreOptics> optics, size_t band) {
    std::vector<FibreOptics> single(optics.begin(), optics.end());
    for (FibreOptics& kind : single) {
        kind.refractive_index = kind.refractive_index[band];
        if (!kind.absorption_per_um.empty())
            kind.absorption_per_um = {kind.absorption_per_um[band]};
    }
    return single;
}

std::vector<FibreMedium> fibre_media(std::span<const FibreOptics> optics, size_t bands,
                                     const kernel::FibreTracer& tracer,
                                     const Colourways& colourways) {
    std::vector<FibreMedium> media;
    if (disperses(optics))
        throw std::invalid_argument("bands of different refractive index share no path");
    for (const FibreOptics& kind : optics) {
        const double index = kind.refractive_index[0];
        if (!(index >= 1) || !std::isfinite(index))
            throw std::invalid_argument("a fibre's refractive index is below 1");
        if (!(kind.surface_absorption >= 0 && kind.surface_absorption <= 1))
            throw std::invalid_argument("a fibre's surface absorption is outside [0, 1]");
        if (!(kind.roughness >= 0 && kind.roughness <= 1))
            throw std::invalid_argument("a fibre's roughness is outside [0, 1]");
        media.push_back({index, -std::log1p(-kind.surface_absorption), {}, kind.roughness});
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

std::vector<std::vector<FibreMedium>> media_of_groups(std::span<const FibreOptics> optics,
                                                      size_t bands,
                                                      const kernel::FibreTracer& tracer,
                                                      const Colourways& colourways) {
    if (!disperses(optics))
        return {fibre_media(optics, bands, tracer, colourways)};
    for (const FibreOptics& kind : optics) {
        const size_t indices = kind.refractive_index.values().size();
        if ((indices != 1 && indices != bands) || kind.absorption_per_um.size() != bands)
            throw std::invalid_argument("a fibre's optics are not given once per band");
    }
    std::vector<std::vector<FibreMedium>> groups;
    for (size_t band = 0; band < bands; ++band) {
        Colourways of_band = colourways;
        for (auto& [name, dyes] : of_band)
            for (std::vector<double>& absorption : dyes) {
                if (absorption.size() != bands)
                    throw std::invalid_argument("a dye is not given once per band");
                absorption = {absorption[band]};
            }
        groups.push_back(fibre_media(in_band(optics, band), 1, tracer, of_band));
    }
    return groups;
}

} // namespace rapport
