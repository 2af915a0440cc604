#include "vgsp/micro_element.h"

#include "renderer/core/error.h"
#include "renderer/core/math.h"
#include "renderer/core/parallel.h"
#include "renderer/core/rng.h"
#include "vgsp/element_report.h"
#include "vgsp/fibre_winding.h"
#include "vgsp/weave.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <fmt/format.h>
#include <numeric>
#include <stdexcept>

namespace rapport {
namespace {

constexpr int kMaxRepeats = 64;      ///< of the draft that twist may ask for, along the yarns
constexpr double kMaxSegments = 1e7; ///< about 2 GB once they are ready to trace

/// Refuses a migration whose bends round fibres could not follow.
void check_irregularity(const YarnSpec& yarn, const std::string& path, const std::string& place) {
    const Irregularity& irregularity = yarn.irregularity;
    const double smallest = 2 * yarn.fibre.diameter_um;
    if (!(irregularity.correlation_length_um() >= smallest * (1 - 1e-9)))
        throw FileError(path, place,
                        fmt::format("a migration_um of at least {:.3g} for deviation_degrees {:g} "
                                    "(a correlation length of two fibre diameters)",
                                    smallest * std::tan(radians(irregularity.deviation_degrees)),
                                    irregularity.deviation_degrees),
                        fmt::format("{:g}", irregularity.migration_um));
}

/// The warp or the weft of the cloth.
struct YarnSystem {
    FibreKind kind = kWarpFibre;
    std::string name, sett_name;
    const YarnSpec* yarn = nullptr;
    double spacing = 0; ///< of its yarns [µm]
    double crimp = 0;   ///< Peirce's h: the axis' height from peak to peak [µm]
    SectionLayout section;
    std::vector<std::vector<uint8_t>> above; ///< [yarn][crossing], of one repeat of the draft
    std::vector<YarnAxis> axes;              ///< of each yarn, one repeat long
    int repeats = 1;                         ///< of the draft along the yarns, per cell
    double twist_rounding = 0;               ///< relative

    double half_height() const { return section.outline.half_height; }
};

YarnSystem make_system(FibreKind kind, const Cloth& cloth) {
    const bool warp = kind == kWarpFibre;
    YarnSystem system;
    system.kind = kind;
    system.name = warp ? "warp" : "weft";
    system.sett_name = warp ? "ends_per_cm" : "picks_per_cm";
    system.yarn = warp ? &cloth.warp : &cloth.weft;
    const double sett = warp ? cloth.ends_per_cm : cloth.picks_per_cm;
    if (!(sett > 0 && std::isfinite(sett)))
        throw FileError(cloth.path.string(), system.sett_name, "a positive sett",
                        fmt::format("{:g}", sett));
    system.spacing = 1e4 / sett;
    system.section = lay_out_section(*system.yarn, cloth.path.string(), system.name);
    check_irregularity(*system.yarn, cloth.path.string(), system.name);
    return system;
}

void interlace(const Draft& draft, YarnSystem& warp, YarnSystem& weft) {
    warp.above.assign(draft.ends, std::vector<uint8_t>(draft.picks));
    weft.above.assign(draft.picks, std::vector<uint8_t>(draft.ends));
    for (int pick = 0; pick < draft.picks; ++pick)
        for (int end = 0; end < draft.ends; ++end) {
            warp.above[end][pick] = draft.up(end, pick);
            weft.above[pick][end] = !draft.up(end, pick);
        }
}

/// The largest sett for a spacing, in a person's digits, rounded so that it is itself possible.
std::string largest_sett(double spacing) {
    return fmt::format("at most {:.2f}", std::floor(1e6 / spacing) / 100);
}

/// Refuses yarns that are wider than they are apart.
void check_width(const YarnSystem& system, const Cloth& cloth) {
    const double width = 2 * system.section.outline.half_width;
    if (width > system.spacing * (1 + 1e-9))
        throw FileError(
            cloth.path.string(), system.sett_name,
            fmt::format("{} for a {} yarn {:.4g} µm wide (yarns too thick for the sett)",
                        largest_sett(width), system.name, width),
            fmt::format("{:g}", 1e4 / system.spacing));
}

/// The yarns of `system`, laid over and under those of `crossed`.
void lay_axes(YarnSystem& system, const YarnSystem& crossed, const Cloth& cloth) {
    const WrapCurve wrap(crossed.section.outline, system.half_height());
    const double smallest = wrap.smallest_spacing(crossed.crimp);
    if (crossed.spacing < smallest * (1 - 1e-9))
        throw FileError(cloth.path.string(), crossed.sett_name,
                        fmt::format("{} for a {} yarn {:.4g} µm thick to pass between "
                                    "{} yarns {:.4g} µm × {:.4g} µm (yarns too thick for the sett)",
                                    largest_sett(smallest), system.name, 2 * system.half_height(),
                                    crossed.name, 2 * crossed.section.outline.half_width,
                                    2 * crossed.half_height()),
                        fmt::format("{:g}", 1e4 / crossed.spacing));
    for (const std::vector<uint8_t>& above : system.above)
        system.axes.emplace_back(above, crossed.spacing, wrap, system.crimp, crossed.crimp);
}

/// Turns per repeat of the draft, along each axis, of the symmetry of a section's packing and, in a
/// plied yarn, of its ring of singles. 0 for what does not turn.
struct SymmetryTurns {
    double packing = 0, plies = 0;
};

SymmetryTurns symmetry_turns(const YarnSystem& system, const YarnAxis& axis) {
    const YarnSpec& yarn = *system.yarn;
    const bool winds = yarn.section != YarnSection::parallel && yarn.fibres > 1;
    return {winds ? yarn.twist_per_m * 1e-6 * axis.length() * system.section.symmetry : 0,
            yarn.ply_twist_per_m * 1e-6 * axis.length() * yarn.plies};
}

/// Relative change of the twist that makes `repeats` repeats close.
double rounding_of(double turns_per_repeat, int repeats) {
    const double turns = turns_per_repeat * repeats;
    return turns == 0 ? 0 : std::round(turns) / turns - 1;
}

/// The fewest repeats of the draft after which every yarn's twists, changed by at most 2 %, have
/// turned the packing onto itself.
void close_twist(YarnSystem& system, const Cloth& cloth) {
    const auto rounding = [&] {
        double largest = 0;
        for (const YarnAxis& axis : system.axes) {
            const SymmetryTurns turns = symmetry_turns(system, axis);
            for (const double per_repeat : {turns.packing, turns.plies}) {
                const double change = rounding_of(per_repeat, system.repeats);
                if (std::abs(change) > std::abs(largest))
                    largest = change;
            }
        }
        return largest;
    };
    while (std::abs(system.twist_rounding = rounding()) > 0.02)
        if (++system.repeats > kMaxRepeats)
            throw FileError(cloth.path.string(), system.name,
                            fmt::format("a twist that turns the packing onto itself within {} "
                                        "repeats of the draft (or twist_per_m = 0)",
                                        kMaxRepeats),
                            fmt::format("twist_per_m = {:g}", system.yarn->twist_per_m));
}

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
            FibreSite site{position, section.fibre_radius, {}, {}};
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
MigrationField migration_of(const YarnSystem& system, double cell_length, CounterRng random) {
    const Irregularity& irregularity = system.yarn->irregularity;
    if (irregularity.migration_um == 0)
        return {};
    return {irregularity.migration_um, irregularity.correlation_length_um(),
            migration_width(system.section.outline), cell_length, random};
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

/// The fibres of yarn number `index` of the cell; `random_index` tells its random numbers from
/// those of all other yarns.
std::vector<kernel::FibreChain> wind_yarn(const YarnSystem& system, size_t index,
                                          size_t random_index, const MicroElementOptions& options) {
    const YarnAxis& axis = system.axes[index % system.axes.size()];
    const SectionLayout& section = system.section;
    const bool warp = system.kind == kWarpFibre;
    const double cell_length = axis.length() * system.repeats;
    const SymmetryTurns turns = symmetry_turns(system, axis);
    const int packing_steps = int(std::lround(turns.packing * system.repeats));
    const int ply_steps = int(std::lround(turns.plies * system.repeats));
    const double across = (index + 0.5) * system.spacing;
    const auto random = [&](Purpose purpose, uint64_t sample) {
        return CounterRng(options.seed, purpose, random_index, sample);
    };
    const PlacedYarn yarn{&axis,
                          &section,
                          warp ? glm::dvec3(across, 0, 0) : glm::dvec3(0, across, 0),
                          warp ? glm::dvec3(0, 1, 0) : glm::dvec3(1, 0, 0),
                          system.crimp / 2,
                          2 * kPi * packing_steps / (section.symmetry * cell_length),
                          2 * kPi * ply_steps / (section.plies * cell_length),
                          migration_of(system, cell_length, random(Purpose::fibre_jitter, 0))};
    std::vector<FibreSite> sites = fibre_sites(section, packing_steps, ply_steps);
    CounterRng scatter = random(Purpose::fibre_jitter, 1);
    scatter_fibres(sites, section, *system.yarn, cell_length, scatter);

    const JointSpacing joints{radians(options.max_turn_degrees),
                              std::min(16 * section.fibre_radius, system.spacing / 2)};
    const double sampling_step = std::min(
        2 * joints.max_turn * smallest_bend(yarn, system.yarn->irregularity), cell_length / 8);
    std::vector<kernel::FibreChain> chains;
    for (const FibreSite& site : sites) {
        const double cells = double(site.turns.size());
        const ClosedCurve curve{[&](double s) { return yarn.fibre_point(site, s); },
                                cell_length * cells, sampling_step,
                                axis.period() * system.repeats * cells * yarn.direction};
        CounterRng dithered = random(Purpose::fibre_dither, chains.size());
        const double dither = options.dither ? dithered.uniform() : 0;
        chains.push_back(
            {place_joints(curve, joints, dither), curve.period, site.radius, system.kind});
    }
    return chains;
}

/// About the least that the system needs of segments in the cell: what the turns of its axes and
/// the migration (its mean curvature is √(3π/2)·σ/ℓ²) ask for.
double fewest_segments(const YarnSystem& system, const YarnSystem& crossed,
                       const MicroElementOptions& options) {
    const Irregularity& irregularity = system.yarn->irregularity;
    const double wandering = std::sqrt(1.5 * kPi) * irregularity.migration_um /
                             square(irregularity.correlation_length_um());
    double turn = 0;
    for (const YarnAxis& axis : system.axes)
        turn += std::max(axis.turn(), wandering * axis.length());
    return turn * system.repeats * crossed.repeats * system.yarn->fibres * system.yarn->plies /
           radians(options.max_turn_degrees);
}

std::optional<double> mass_of(const kernel::FibreAssembly& assembly,
                              const std::vector<kernel::FibreSegment>& segments,
                              const Cloth& cloth) {
    const std::array densities{cloth.warp.fibre.density_g_cm3, cloth.weft.fibre.density_g_cm3};
    double mass = 0; // µm³·g/cm³
    for (const kernel::FibreSegment& s : segments) {
        if (!densities[s.kind])
            return std::nullopt;
        mass += kPi * square(s.radius) * s.length * *densities[s.kind];
    }
    return mass / (assembly.cell.x * assembly.cell.y); // 1 µm·g/cm³ = 1 g/m²
}

double mean_crimp(const YarnSystem& system) {
    double sum = 0;
    for (const YarnAxis& axis : system.axes)
        sum += axis.length() / axis.period() - 1;
    return sum / system.axes.size();
}

} // namespace

MicroElement build_micro_element(const Cloth& cloth, const MicroElementOptions& options) {
    if (!(options.max_turn_degrees > 0))
        throw std::invalid_argument("max_turn_degrees is not positive");
    const std::string path = cloth.path.string();
    if (!(cloth.crimp_balance >= 0 && cloth.crimp_balance <= 1))
        throw FileError(path, "crimp_balance", "a number from 0 to 1",
                        fmt::format("{:g}", cloth.crimp_balance));
    const Draft draft = weavable(cloth.draft, path);
    YarnSystem warp = make_system(kWarpFibre, cloth);
    YarnSystem weft = make_system(kWeftFibre, cloth);
    interlace(draft, warp, weft);
    check_width(warp, cloth);
    check_width(weft, cloth);

    // Peirce: the two crimp heights share out the thickness of both yarns.
    const double both = 2 * (warp.half_height() + weft.half_height());
    warp.crimp = cloth.crimp_balance * both;
    weft.crimp = both - warp.crimp;
    lay_axes(warp, weft, cloth);
    lay_axes(weft, warp, cloth);

    close_twist(warp, cloth);
    close_twist(weft, cloth);

    MicroElement element;
    element.repeats_x = weft.repeats;
    element.repeats_y = warp.repeats;
    const size_t ends = size_t(draft.ends) * weft.repeats;
    const size_t picks = size_t(draft.picks) * warp.repeats;
    const double fewest =
        fewest_segments(warp, weft, options) + fewest_segments(weft, warp, options);
    if (fewest > kMaxSegments)
        throw FileError(path, "draft",
                        fmt::format("a cell of at most {:.2g} cylinders (fewer fibres, a smaller "
                                    "repeat, or a twist that closes sooner)",
                                    kMaxSegments),
                        fmt::format("{:.2g} for {} ends × {} picks", fewest, ends, picks));

    element.fibres.cell = {double(ends) * warp.spacing, double(picks) * weft.spacing};
    std::vector<std::vector<kernel::FibreChain>> yarns(ends + picks);
    parallel_for(yarns.size(), [&](size_t k) {
        yarns[k] =
            k < ends ? wind_yarn(warp, k, k, options) : wind_yarn(weft, k - ends, k, options);
    });
    for (std::vector<kernel::FibreChain>& yarn : yarns)
        std::move(yarn.begin(), yarn.end(), std::back_inserter(element.fibres.chains));

    const std::vector<kernel::FibreSegment> segments = kernel::fibre_segments(element.fibres);
    element.segments = segments.size();
    element.overlap_fraction = overlap_fraction(element.fibres, segments);
    element.mass_g_per_m2 = mass_of(element.fibres, segments, cloth);
    element.thickness_um =
        2 * std::max(warp.crimp / 2 + warp.half_height(), weft.crimp / 2 + weft.half_height());
    element.warp_cover = 2 * warp.section.outline.half_width / warp.spacing;
    element.weft_cover = 2 * weft.section.outline.half_width / weft.spacing;
    element.cover_factor =
        element.warp_cover + element.weft_cover - element.warp_cover * element.weft_cover;
    element.twist_rounding_warp = warp.twist_rounding;
    element.twist_rounding_weft = weft.twist_rounding;
    element.crimp_warp = mean_crimp(warp);
    element.crimp_weft = mean_crimp(weft);
    return element;
}

} // namespace rapport
