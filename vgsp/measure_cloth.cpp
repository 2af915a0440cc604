#include "vgsp/measure_cloth.h"

#include "renderer/core/error.h"
#include "renderer/core/rng.h"
#include "renderer/core/text_hash.h"
#include "vgsp/colour_solver.h"

#include <algorithm>
#include <chrono>
#include <fmt/format.h>
#include <fmt/ranges.h>

namespace rapport {
namespace {

/// The first has the run's own seed, so that it is the cloth that a single one would be.
uint64_t realisation_seed(uint64_t seed, int realisation) {
    if (realisation == 0)
        return seed;
    CounterRng random(seed, Purpose::realisation, 0, static_cast<uint64_t>(realisation));
    const uint64_t high = random.bits();
    return high << 32 | random.bits();
}

/// Turns dyes into absorption.
class Dyer {
  public:
    Dyer(const Cloth& cloth, const kernel::FibreTracer& tracer, std::span<const FibreOptics> undyed,
         const GoniophotometerSettings& settings)
        : cloth_(cloth), tracer_(tracer), undyed_(undyed), settings_(settings) {}

    /// [1/µm] per band; `place` is where the file tells of the dye.
    std::vector<double> absorption(const Dye& dye, const std::string& place) {
        if (dye.absorption_per_um)
            return *dye.absorption_per_um;
        std::vector<double> absorption(cloth_.bands.count(), 0.0);
        for (size_t band = 0; dye.color && band < absorption.size(); ++band)
            absorption[band] = solved(band, (*dye.color)[band], place + ".color");
        return absorption;
    }

  private:
    double solved(size_t band, double albedo, const std::string& place) {
        const size_t group = disperses(undyed_) ? band : 0;
        const ColourSolver& solver =
            solvers_.try_emplace(group, tracer_, in_band(undyed_, group), settings_).first->second;
        const std::optional<double> absorption = solver.absorption_for(albedo);
        if (!absorption)
            throw FileError(cloth_.path.string(), place,
                            fmt::format("an albedo this cloth can have, {:.3f} to {:.3f}",
                                        solver.least_albedo(), solver.greatest_albedo()),
                            fmt::format("{}", albedo));
        return *absorption;
    }

    const Cloth& cloth_;
    const kernel::FibreTracer& tracer_;
    std::span<const FibreOptics> undyed_;
    const GoniophotometerSettings& settings_;
    std::map<size_t, ColourSolver> solvers_; ///< by band, or one for all bands
};

/// Numbers in the shortest form that reads back the same.
std::map<std::string, std::string> metadata(const Cloth& cloth, const MicroElement& element,
                                            const MicroElementOptions& geometry,
                                            const ClothOptics& optics, int realisations,
                                            const GoniophotometerSettings& settings) {
    std::map<std::string, std::string> metadata{
        {"program", fmt::format("rapport {}", RAPPORT_VERSION)},
        {"cloth_name", cloth.name},
        {"cloth", cloth.source},
        {"cloth_hash", text_hash(cloth.source)},
        {"bands", fmt::format("{}", fmt::join(cloth.bands.names, " "))},
        {"dispersion", disperses(optics.fibres) ? "yes" : "no"},
        {"seed", fmt::format("{}", settings.seed)},
        {"accuracy_asked", fmt::format("{}", settings.accuracy)},
        {"max_paths", fmt::format("{}", settings.max_paths)},
        {"max_events", fmt::format("{}", settings.max_events)},
        {"colour_paths", fmt::format("{}", settings.colour_paths)},
        {"realisations", fmt::format("{}", realisations)},
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
    for (size_t k = 0; k < kinds.size(); ++k) {
        const std::string key = kinds[k].place + "_absorption_per_um";
        metadata[key] = fmt::format("{}", fmt::join(optics.fibres[k].absorption_per_um, " "));
        for (const auto& [name, dyes] : optics.colourways)
            metadata[fmt::format("colourway.{}.{}", name, key)] =
                fmt::format("{}", fmt::join(dyes[k], " "));
    }
    return metadata;
}

} // namespace

std::array<ConeAxis, 2> facing_yarns(const kernel::FibreTracer& tracer) {
    constexpr int kRays = 64; // along each edge of the cell
    constexpr double kClearlyMore = 1.2;
    std::array<ConeAxis, 2> facing{};
    for (const size_t side : {0, 1}) {
        const double height = side == 0 ? tracer.z_max() + 1 : tracer.z_min() - 1;
        const glm::dvec3 down(0, 0, side == 0 ? -1 : 1);
        std::array<int, 2> seen{};
        for (int i = 0; i < kRays * kRays; ++i) {
            const glm::dvec2 at((i % kRays + 0.5) / kRays, (i / kRays + 0.5) / kRays);
            const kernel::FibreTracer::Entry entry = tracer.enter(
                glm::dvec3(at * tracer.cell(), height), down, kernel::FibreTracer::kNone);
            if (entry.flight != kernel::FibreTracer::Flight::enters)
                continue;
            const glm::dvec3 along = tracer.segments()[entry.point.segment].direction;
            ++seen[std::abs(along.x) > std::abs(along.y) ? 1 : 0];
        }
        if (seen[1] > kClearlyMore * seen[0])
            facing[side] = ConeAxis::weft;
    }
    return facing;
}

std::vector<FibreOptics> ClothOptics::dyed(const Colourways::mapped_type& dyes) const {
    std::vector<FibreOptics> made = fibres;
    for (size_t kind = 0; kind < made.size(); ++kind)
        made[kind].absorption_per_um = dyes[kind];
    return made;
}

ClothOptics cloth_optics(const Cloth& cloth, const kernel::FibreTracer& tracer,
                         const GoniophotometerSettings& settings) {
    const std::vector<YarnKind> kinds = yarn_kinds(cloth);
    ClothOptics optics;
    for (const YarnKind& kind : kinds)
        optics.fibres.push_back({kind.yarn->fibre.refractive_index,
                                 {},
                                 kind.yarn->fibre.surface_absorption,
                                 kind.yarn->fibre.roughness});
    const std::vector<FibreOptics> undyed = optics.fibres;
    Dyer dyer(cloth, tracer, undyed, settings);
    for (size_t k = 0; k < kinds.size(); ++k)
        optics.fibres[k].absorption_per_um =
            dyer.absorption(kinds[k].yarn->fibre, kinds[k].place + ".fibre");
    for (const auto& [name, dyes] : cloth.colourways)
        for (size_t k = 0; k < kinds.size(); ++k) {
            const auto dye = dyes.find(kinds[k].place);
            optics.colourways[name].push_back(
                dye == dyes.end() ? optics.fibres[k].absorption_per_um
                                  : dyer.absorption(dye->second, fmt::format("colourway.{}.{}",
                                                                             name, dye->first)));
        }
    return optics;
}

Realisations build_realisations(const Cloth& cloth, const MicroElementOptions& geometry, int count,
                                double memory) {
    if (count < 1)
        throw std::invalid_argument("no realisation of the cloth");
    Realisations result{build_micro_element(cloth, geometry), {}};
    while (count > 1 && count * result.first.memory > memory)
        --count;
    result.tracers.emplace_back(result.first.fibres);
    for (int i = 1; i < count; ++i) {
        MicroElementOptions other = geometry;
        other.seed = realisation_seed(geometry.seed, i);
        result.tracers.emplace_back(build_micro_element(cloth, other).fibres);
    }
    return result;
}

ClothMeasurement
measure_cloth(const Cloth& cloth, const MeasureOptions& options,
              const std::function<void(const GoniophotometerProgress&)>& progress) {
    const auto start = std::chrono::steady_clock::now();
    GoniophotometerSettings settings = options.goniophotometer;
    const MicroElementOptions geometry{.seed = settings.seed, .stopped = settings.stopped};
    Realisations realisations =
        build_realisations(cloth, geometry, options.realisations, options.memory);
    ClothMeasurement result{options.incidence.empty()
                                ? make_full_table(cloth.bands, options.front, options.back)
                                : make_partial_table(cloth.bands, options.incidence),
                            std::move(realisations.first),
                            static_cast<int>(realisations.tracers.size()),
                            {}};
    result.table.exit_axis = facing_yarns(realisations.tracers[0]);
    const ClothOptics optics = cloth_optics(cloth, realisations.tracers[0], settings);
    result.table.metadata =
        metadata(cloth, result.element, geometry, optics, result.realisations, settings);
    if (settings.max_seconds > 0) { // what is left of them, more than nothing
        const std::chrono::duration<double> spent = std::chrono::steady_clock::now() - start;
        settings.max_seconds = std::max(settings.max_seconds - spent.count(), 1e-9);
    }
    result.counts = measure(realisations.tracers, optics.fibres, settings, result.table, progress,
                            options.checkpoint, optics.colourways);
    return result;
}

} // namespace rapport
