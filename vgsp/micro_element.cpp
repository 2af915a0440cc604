#include "vgsp/micro_element.h"

#include "renderer/core/error.h"
#include "renderer/core/math.h"
#include "renderer/core/parallel.h"
#include "renderer/core/rng.h"
#include "renderer/kernel/fibre_tracer.h"
#include "vgsp/element_report.h"
#include "vgsp/fibre_winding.h"
#include "vgsp/weave.h"
#include "vgsp/yarn_system.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <stdexcept>

namespace rapport {
namespace {

/// The fibres of a yarn, one for each chain. After one cell a fibre goes on as the one
/// `packing_steps` places further round its single and `ply_steps` singles further round the yarn;
/// it closes when it comes back to its place, and is then all the fibres that it has met.
std::vector<FibreSite> fibre_sites(const SectionLayout& section, int packing_steps, int ply_steps) {
    const auto turns_on = [](int steps, int order) { return (steps % order + order) % order; };
    std::vector<FibreSite> sites;
    for (const glm::dvec2& position : section.fibres) {
        const int order = section.copies(position), plies = section.plies;
        std::vector<uint8_t> met(size_t(order) * plies, 0);
        for (int start = 0; start < order * plies; ++start) {
            if (met[start])
                continue;
            FibreSite site{position, section.fibre_radius, {}, {}, 0};
            int place = start % order, ply = start / order;
            while (!met[size_t(ply) * order + place]) {
                met[size_t(ply) * order + place] = 1;
                site.turns.push_back({2 * kPi * place / order, 2 * kPi * ply / plies});
                place = (place + turns_on(packing_steps, order)) % order;
                ply = (ply + turns_on(ply_steps, plies)) % plies;
            }
            sites.push_back(std::move(site));
        }
    }
    return sites;
}

/// The migration of one yarn's fibres.
MigrationField migration_of(const SystemYarn& yarn, double cell_length, CounterRng random) {
    const Irregularity& irregularity = yarn.yarn->irregularity;
    if (irregularity.migration_um == 0)
        return {};
    return {irregularity.migration_um, irregularity.correlation_length_um(),
            migration_width(yarn.section.outline), cell_length, random};
}

/// The smallest radius of curvature to reckon with in a yarn's fibres [µm].
double smallest_bend(const PlacedYarn& yarn, const Irregularity& irregularity) {
    const double twist = std::abs(yarn.twist) + std::abs(yarn.ply_twist);
    double bend = yarn.axis->smallest_curvature_radius();
    if (twist != 0)
        bend = std::min(bend, 1 / twist);
    if (irregularity.migration_um > 0) // three standard deviations, √3·σ/ℓ²
        bend = std::min(bend, square(irregularity.correlation_length_um()) /
                                  (3 * std::sqrt(3.0) * irregularity.migration_um));
    return bend;
}

struct WoundYarn {
    std::vector<kernel::FibreChain> fibres;
    double volume = 0, thinned = 0; ///< of the fibres as drawn, and what they gave up of it [µm³]
};

/// The fibres of yarn number `index` of the cell, which lies along `direction`; `random_index`
/// tells its random numbers from those of all other yarns.
WoundYarn wind_yarn(const YarnSystem& system, const glm::dvec3& direction, size_t index,
                    size_t random_index, const MicroElementOptions& options) {
    const YarnAxis& axis = system.axes[index % system.axes.size()];
    const SystemYarn& kind = system.yarn(index);
    const SectionLayout& section = kind.section;
    const double cell_length = axis.length() * system.repeats;
    const SymmetryTurns turns = symmetry_turns(kind, axis);
    const int packing_steps = int(std::lround(turns.packing * system.repeats));
    const int ply_steps = int(std::lround(turns.plies * system.repeats));
    const double across = (index + 0.5) * system.spacing;
    const auto random = [&](Purpose purpose, uint64_t sample) {
        return CounterRng(options.seed, purpose, random_index, sample);
    };
    const PlacedYarn yarn{&axis,
                          &section,
                          across * glm::dvec3(direction.y, direction.x, 0),
                          direction,
                          2 * kPi * packing_steps / (section.symmetry * cell_length),
                          2 * kPi * ply_steps / (section.plies * cell_length),
                          migration_of(kind, cell_length, random(Purpose::fibre_jitter, 0))};
    std::vector<FibreSite> sites = fibre_sites(section, packing_steps, ply_steps);
    CounterRng scatter = random(Purpose::fibre_jitter, 1);
    scatter_fibres(sites, section, *kind.yarn, cell_length, scatter);

    const JointSpacing joints{radians(options.max_turn_degrees),
                              std::min(16 * section.fibre_radius, system.spacing / 2)};
    const double sampling_step = std::min(
        2 * joints.max_turn * smallest_bend(yarn, kind.yarn->irregularity), cell_length / 8);
    WoundYarn wound;
    for (const FibreSite& site : sites) {
        throw_if(options.stopped);
        const double cells = double(site.turns.size());
        const ClosedCurve curve{[&](double s) { return yarn.fibre_point(site, s); },
                                cell_length * cells, sampling_step,
                                axis.period() * system.repeats * cells * direction};
        CounterRng dithered = random(Purpose::fibre_dither, wound.fibres.size());
        const double dither = options.dither ? dithered.uniform() : 0;
        wound.fibres.push_back(
            {place_joints(curve, joints, dither), curve.period, site.radius, kind.kind});
        const double drawn = kPi * square(site.radius) / (1 - site.thinned) * curve.length;
        wound.volume += drawn;
        wound.thinned += site.thinned * drawn;
    }
    return wound;
}

/// About the least that the system needs of segments in the cell: what the turns of its axes and
/// the migration (its mean curvature is √(3π/2)·σ/ℓ²) ask for.
double fewest_segments(const YarnSystem& system, const YarnSystem& crossed,
                       const MicroElementOptions& options) {
    double turn = 0; // of all fibres in one repeat
    for (size_t i = 0; i < system.axes.size(); ++i) {
        const YarnSpec& yarn = *system.yarn(i).yarn;
        const double wandering = std::sqrt(1.5 * kPi) * yarn.irregularity.migration_um /
                                 square(yarn.irregularity.correlation_length_um());
        turn += yarn.fibres * yarn.plies *
                std::max(system.axes[i].turn(), wandering * system.axes[i].length());
    }
    return turn * system.repeats * crossed.repeats / radians(options.max_turn_degrees);
}

/// What the cell takes [bytes]; refused where that is too much. `bound` says of which kind the
/// number of segments is.
double checked_memory(double segments, const char* bound, const MicroElement& element,
                      const Cloth& cloth, size_t ends, size_t picks) {
    const double memory =
        kernel::FibreTracer::memory(segments, element.fibres.cell, element.thickness_um) +
        segments * sizeof(glm::dvec3);
    if (memory > kMostMemory)
        throw FileError(cloth.path.string(), "draft",
                        fmt::format("a cell that takes at most {:.2g} GB (fewer fibres, a smaller "
                                    "repeat, or a twist that closes sooner)",
                                    kMostMemory * 1e-9),
                        fmt::format("{} ends × {} picks of {}{:.2g} cylinders, {:.2g} GB", ends,
                                    picks, bound, segments, memory * 1e-9));
    return memory;
}

/// The fibres' cylinders; refused where chance or twist bends one too sharply for any.
std::vector<kernel::FibreSegment> cylinders(const kernel::FibreAssembly& fibres,
                                            const std::string& path, const StopSignal& stopped) {
    try {
        return kernel::fibre_segments(fibres, stopped);
    } catch (const std::invalid_argument& bend) {
        throw FileError(path, "deviation_degrees",
                        "fibres that bend no more sharply than they are thick (less deviation or "
                        "twist, or more migration_um)",
                        bend.what());
    }
}

std::optional<double> mass_of(const kernel::FibreAssembly& assembly,
                              const std::vector<kernel::FibreSegment>& segments,
                              const Cloth& cloth) {
    std::vector<std::optional<double>> densities;
    for (const YarnKind& kind : yarn_kinds(cloth))
        densities.push_back(kind.yarn->fibre.density_g_cm3);
    double mass = 0; // µm³·g/cm³
    for (const kernel::FibreSegment& s : segments) {
        if (!densities[s.kind])
            return std::nullopt;
        mass += kPi * square(s.radius) * s.length * *densities[s.kind];
    }
    return mass / (assembly.cell.x * assembly.cell.y); // 1 µm·g/cm³ = 1 g/m²
}

} // namespace

MicroElement build_micro_element(const Cloth& cloth, const MicroElementOptions& options) {
    if (!(options.max_turn_degrees > 0))
        throw std::invalid_argument("max_turn_degrees is not positive");
    if (options.least_repeats < 1)
        throw std::invalid_argument("a cell of no repeat");
    const std::string path = cloth.path.string();
    if (!(cloth.crimp_balance >= 0 && cloth.crimp_balance <= 1))
        throw FileError(path, "crimp_balance", "a number from 0 to 1",
                        fmt::format("{:g}", cloth.crimp_balance));
    const Draft draft = weavable(cloth.draft, path);
    const YarnSystems systems = lay_systems(cloth, draft, options.least_repeats);
    const YarnSystem &warp = systems.warp, &weft = systems.weft;

    MicroElement element;
    element.repeats_x = weft.repeats;
    element.repeats_y = warp.repeats;
    const size_t ends = size_t(draft.ends) * weft.repeats;
    const size_t picks = size_t(draft.picks) * warp.repeats;
    element.fibres.cell = {double(ends) * warp.spacing, double(picks) * weft.spacing};
    element.thickness_um = 2 * std::max(warp.greatest_height(), weft.greatest_height());
    checked_memory(fewest_segments(warp, weft, options) + fewest_segments(weft, warp, options),
                   "at least ", element, cloth, ends, picks);
    std::vector<WoundYarn> yarns(ends + picks);
    parallel_for(yarns.size(), [&](size_t k) {
        yarns[k] = k < ends ? wind_yarn(warp, {0, 1, 0}, k, k, options)
                            : wind_yarn(weft, {1, 0, 0}, k - ends, k, options);
    });
    double volume = 0;
    for (WoundYarn& yarn : yarns) {
        std::ranges::move(yarn.fibres, std::back_inserter(element.fibres.chains));
        volume += yarn.volume;
        element.thinned += yarn.thinned;
    }
    element.thinned /= volume;

    for (const kernel::FibreChain& chain : element.fibres.chains)
        element.segments += chain.points.size();
    element.memory = checked_memory(double(element.segments), "", element, cloth, ends, picks);
    const std::vector<kernel::FibreSegment> segments =
        cylinders(element.fibres, path, options.stopped);
    element.overlap_fraction = overlap_fraction(element.fibres, segments, options.stopped);
    element.mass_g_per_m2 = mass_of(element.fibres, segments, cloth);
    element.warp_cover = 2 * warp.mean_half_width() / warp.spacing;
    element.weft_cover = 2 * weft.mean_half_width() / weft.spacing;
    element.cover_factor =
        element.warp_cover + element.weft_cover - element.warp_cover * element.weft_cover;
    element.twist_rounding_warp = warp.twist_rounding;
    element.twist_rounding_weft = weft.twist_rounding;
    element.crimp_warp = warp.mean_crimp();
    element.crimp_weft = weft.mean_crimp();
    return element;
}

} // namespace rapport
