#include "vgsp/measure_cloth.h"

#include "renderer/core/error.h"
#include "vgsp/colour_solver.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace rapport {
namespace {

/// FNV-1a, 64 bits: tells one cloth's text from another's, the same on every machine. No defence
/// against forgery.
uint64_t text_hash(const std::string& text) {
    uint64_t hash = 0xcbf29ce484222325;
    for (const char character : text)
        hash = (hash ^ static_cast<unsigned char>(character)) * 0x100000001b3;
    return hash;
}

FibreOptics undyed(const FibreSpec& fibre, size_t bands) {
    return {fibre.refractive_index,
            fibre.absorption_per_um.value_or(std::vector<double>(bands, 0.0)),
            fibre.surface_absorption};
}

void dye(FibreOptics& optics, const FibreSpec& fibre, const ColourSolver& solver,
         const Cloth& cloth, const char* place) {
    for (size_t band = 0; band < fibre.color->size(); ++band) {
        const double wanted = (*fibre.color)[band];
        const std::optional<double> absorption = solver.absorption_for(wanted);
        if (!absorption)
            throw FileError(cloth.path.string(), place,
                            fmt::format("an albedo this cloth can have, {:.3f} to {:.3f}",
                                        solver.least_albedo(), solver.greatest_albedo()),
                            fmt::format("{}", wanted));
        optics.absorption_per_um[band] = *absorption;
    }
}

/// Of warp and weft, in the order of FibreKind.
std::vector<FibreOptics> cloth_optics(const Cloth& cloth, const kernel::FibreTracer& tracer,
                                      const GoniophotometerSettings& settings) {
    const size_t bands = cloth.bands.count();
    std::vector<FibreOptics> optics{undyed(cloth.warp.fibre, bands),
                                    undyed(cloth.weft.fibre, bands)};
    if (cloth.warp.fibre.color || cloth.weft.fibre.color) {
        const ColourSolver solver(tracer, optics, settings.max_events, settings.seed);
        if (cloth.warp.fibre.color)
            dye(optics[kWarpFibre], cloth.warp.fibre, solver, cloth, "warp.fibre.color");
        if (cloth.weft.fibre.color)
            dye(optics[kWeftFibre], cloth.weft.fibre, solver, cloth, "weft.fibre.color");
    }
    return optics;
}

/// Numbers in the shortest form that reads back the same.
std::map<std::string, std::string> metadata(const Cloth& cloth, const MicroElement& element,
                                            const MicroElementOptions& geometry,
                                            const std::vector<FibreOptics>& optics,
                                            const GoniophotometerSettings& settings) {
    return {
        {"program", fmt::format("rapport {}", RAPPORT_VERSION)},
        {"cloth_name", cloth.name},
        {"cloth", cloth.source},
        {"cloth_hash", fmt::format("fnv1a64:{:016x}", text_hash(cloth.source))},
        {"bands", fmt::format("{}", fmt::join(cloth.bands.names, " "))},
        {"seed", fmt::format("{}", settings.seed)},
        {"accuracy_asked", fmt::format("{}", settings.accuracy)},
        {"max_paths", fmt::format("{}", settings.max_paths)},
        {"max_events", fmt::format("{}", settings.max_events)},
        {"max_turn_degrees", fmt::format("{}", geometry.max_turn_degrees)},
        {"dither", geometry.dither ? "yes" : "no"},
        {"draft_repeats", fmt::format("{} x {}", element.repeats_x, element.repeats_y)},
        {"fibres", fmt::format("{}", element.fibres.chains.size())},
        {"segments", fmt::format("{}", element.segments)},
        {"cell_um", fmt::format("{} x {}", element.fibres.cell.x, element.fibres.cell.y)},
        {"thickness_um", fmt::format("{}", element.thickness_um)},
        {"cover_factor", fmt::format("{}", element.cover_factor)},
        {"warp_cover", fmt::format("{}", element.warp_cover)},
        {"weft_cover", fmt::format("{}", element.weft_cover)},
        {"warp_crimp", fmt::format("{}", element.crimp_warp)},
        {"weft_crimp", fmt::format("{}", element.crimp_weft)},
        {"overlap_fraction", fmt::format("{}", element.overlap_fraction)},
        {"warp_twist_rounding", fmt::format("{}", element.twist_rounding_warp)},
        {"weft_twist_rounding", fmt::format("{}", element.twist_rounding_weft)},
        {"warp_absorption_per_um",
         fmt::format("{}", fmt::join(optics[kWarpFibre].absorption_per_um, " "))},
        {"weft_absorption_per_um",
         fmt::format("{}", fmt::join(optics[kWeftFibre].absorption_per_um, " "))},
    };
}

} // namespace

ClothMeasurement
measure_cloth(const Cloth& cloth, const MeasureOptions& options,
              const std::function<void(const GoniophotometerProgress&)>& progress) {
    const GoniophotometerSettings& settings = options.goniophotometer;
    const MicroElementOptions geometry{.seed = settings.seed};
    ClothMeasurement result{options.incidence.empty()
                                ? make_full_table(cloth.bands, options.front, options.back)
                                : make_partial_table(cloth.bands, options.incidence),
                            build_micro_element(cloth, geometry),
                            {}};
    const kernel::FibreTracer tracer(result.element.fibres);
    const std::vector<FibreOptics> optics = cloth_optics(cloth, tracer, settings);
    result.counts = measure(tracer, optics, settings, result.table, progress);
    result.table.metadata = metadata(cloth, result.element, geometry, optics, settings);
    return result;
}

} // namespace rapport
