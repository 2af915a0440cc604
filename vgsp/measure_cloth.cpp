#include "vgsp/measure_cloth.h"

#include "renderer/core/error.h"
#include "renderer/core/rng.h"
#include "vgsp/colour_solver.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace rapport {
namespace {

constexpr size_t kMostSegments = 10'000'000; ///< of all realisations, about 2 GB ready to trace

/// The first has the run's own seed, so that it is the cloth that a single one would be.
uint64_t realisation_seed(uint64_t seed, int realisation) {
    if (realisation == 0)
        return seed;
    CounterRng random(seed, Purpose::realisation, 0, static_cast<uint64_t>(realisation));
    const uint64_t high = random.bits();
    return high << 32 | random.bits();
}

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
            fibre.surface_absorption, fibre.roughness};
}

void dye(FibreOptics& optics, const FibreSpec& fibre, const ColourSolver& solver,
         const Cloth& cloth, const std::string& place) {
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

/// Numbers in the shortest form that reads back the same.
std::map<std::string, std::string> metadata(const Cloth& cloth, const MicroElement& element,
                                            const MicroElementOptions& geometry,
                                            const std::vector<FibreOptics>& optics,
                                            const MeasureOptions& options) {
    const GoniophotometerSettings& settings = options.goniophotometer;
    std::map<std::string, std::string> metadata{
        {"program", fmt::format("rapport {}", RAPPORT_VERSION)},
        {"cloth_name", cloth.name},
        {"cloth", cloth.source},
        {"cloth_hash", fmt::format("fnv1a64:{:016x}", text_hash(cloth.source))},
        {"bands", fmt::format("{}", fmt::join(cloth.bands.names, " "))},
        {"seed", fmt::format("{}", settings.seed)},
        {"accuracy_asked", fmt::format("{}", settings.accuracy)},
        {"max_paths", fmt::format("{}", settings.max_paths)},
        {"max_events", fmt::format("{}", settings.max_events)},
        {"realisations", fmt::format("{}", options.realisations)},
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
    };
    const std::vector<YarnKind> kinds = yarn_kinds(cloth);
    for (size_t k = 0; k < kinds.size(); ++k)
        metadata[kinds[k].place + "_absorption_per_um"] =
            fmt::format("{}", fmt::join(optics[k].absorption_per_um, " "));
    return metadata;
}

} // namespace

std::vector<FibreOptics> cloth_optics(const Cloth& cloth, const kernel::FibreTracer& tracer,
                                      const GoniophotometerSettings& settings) {
    const std::vector<YarnKind> kinds = yarn_kinds(cloth);
    std::vector<FibreOptics> optics;
    bool dyed = false;
    for (const YarnKind& kind : kinds) {
        optics.push_back(undyed(kind.yarn->fibre, cloth.bands.count()));
        dyed |= kind.yarn->fibre.color.has_value();
    }
    if (!dyed)
        return optics;
    const ColourSolver solver(tracer, optics, settings.max_events, settings.seed);
    for (size_t k = 0; k < kinds.size(); ++k)
        if (kinds[k].yarn->fibre.color)
            dye(optics[k], kinds[k].yarn->fibre, solver, cloth, kinds[k].place + ".fibre.color");
    return optics;
}

ClothMeasurement
measure_cloth(const Cloth& cloth, const MeasureOptions& options,
              const std::function<void(const GoniophotometerProgress&)>& progress) {
    if (options.realisations < 1)
        throw std::invalid_argument("no realisation of the cloth");
    const GoniophotometerSettings& settings = options.goniophotometer;
    const MicroElementOptions geometry{.seed = settings.seed};
    ClothMeasurement result{options.incidence.empty()
                                ? make_full_table(cloth.bands, options.front, options.back)
                                : make_partial_table(cloth.bands, options.incidence),
                            build_micro_element(cloth, geometry),
                            {}};
    const size_t segments = result.element.segments;
    if (options.realisations > 1 && segments * options.realisations > kMostSegments)
        throw FileError(cloth.path.string(), "realisations",
                        fmt::format("at most {} of {} cylinders each",
                                    std::max<size_t>(1, kMostSegments / segments), segments),
                        fmt::format("{}", options.realisations));
    std::vector<kernel::FibreTracer> realisations;
    realisations.emplace_back(result.element.fibres);
    for (int i = 1; i < options.realisations; ++i) {
        MicroElementOptions other = geometry;
        other.seed = realisation_seed(settings.seed, i);
        realisations.emplace_back(build_micro_element(cloth, other).fibres);
    }
    const std::vector<FibreOptics> optics = cloth_optics(cloth, realisations[0], settings);
    result.table.metadata = metadata(cloth, result.element, geometry, optics, options);
    result.counts =
        measure(realisations, optics, settings, result.table, progress, options.checkpoint);
    return result;
}

} // namespace rapport
