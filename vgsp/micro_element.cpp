#include "vgsp/micro_element.h"

#include "renderer/core/error.h"
#include "renderer/core/math.h"
#include "renderer/core/parallel.h"
#include "renderer/core/rng.h"
#include "vgsp/element_report.h"
#include "vgsp/fibre_winding.h"
#include "vgsp/weave.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <numeric>
#include <stdexcept>

namespace rapport {
namespace {

constexpr int kMaxRepeats = 64;      ///< of the draft that twist may ask for, along the yarns
constexpr double kMaxSegments = 1e7; ///< about 2 GB once they are ready to trace

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

/// Turns of the packing's symmetry per repeat of the draft, for each axis; 0 without twist.
double symmetry_turns(const YarnSystem& system, const YarnAxis& axis) {
    const bool winds = system.yarn->section == YarnSection::twisted && system.yarn->fibres > 1;
    return winds ? system.yarn->twist_per_m * 1e-6 * axis.length() * system.section.symmetry : 0;
}

/// Relative change of the twist that makes `repeats` repeats close.
double rounding_of(double turns_per_repeat, int repeats) {
    const double turns = turns_per_repeat * repeats;
    return turns == 0 ? 0 : std::round(turns) / turns - 1;
}

/// The fewest repeats of the draft after which every yarn's twist, changed by at most 2 %, has
/// turned the packing onto itself.
void close_twist(YarnSystem& system, const Cloth& cloth) {
    const auto rounding = [&] {
        double largest = 0;
        for (const YarnAxis& axis : system.axes) {
            const double change = rounding_of(symmetry_turns(system, axis), system.repeats);
            if (std::abs(change) > std::abs(largest))
                largest = change;
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

/// The fibres of yarn number `index` of the cell; `random_index` tells its random numbers from
/// those of all other yarns.
std::vector<kernel::FibreChain> wind_yarn(const YarnSystem& system, size_t index,
                                          size_t random_index, const MicroElementOptions& options) {
    const YarnAxis& axis = system.axes[index % system.axes.size()];
    const SectionLayout& section = system.section;
    const bool warp = system.kind == kWarpFibre;
    const double cell_length = axis.length() * system.repeats;
    const int order = section.symmetry;
    const int steps = int(std::lround(symmetry_turns(system, axis) * system.repeats));
    const double twist = 2 * kPi * steps / (order * cell_length);
    const double across = (index + 0.5) * system.spacing;
    const PlacedYarn yarn{&axis, &section,
                          warp ? glm::dvec3(across, 0, 0) : glm::dvec3(0, across, 0),
                          warp ? glm::dvec3(0, 1, 0) : glm::dvec3(1, 0, 0), twist};

    const JointSpacing joints{radians(options.max_turn_degrees),
                              std::min(16 * section.fibre_radius, system.spacing / 2)};
    const double bend = twist == 0
                            ? axis.smallest_curvature_radius()
                            : std::min(axis.smallest_curvature_radius(), 1 / std::abs(twist));
    const double sampling_step = std::min(2 * joints.max_turn * bend, cell_length / 8);

    // After one cell a fibre goes on as the one `steps` places further round the axis. It closes
    // after order ÷ shared cells and is then all the fibres that it has met; `shared` such chains
    // make up the whole set.
    const int shared = std::gcd(std::abs(steps), order);
    std::vector<kernel::FibreChain> chains;
    for (const glm::dvec2& position : section.fibres) {
        const bool centre = section.copies(position) == 1;
        const int count = centre ? 1 : shared, cells = centre ? 1 : order / shared;
        for (int k = 0; k < count; ++k) {
            const double phase = 2 * kPi * k / order;
            const ClosedCurve curve{[&](double s) { return yarn.fibre_point(position, phase, s); },
                                    cell_length * cells, sampling_step,
                                    axis.period() * system.repeats * cells * yarn.direction};
            CounterRng random(options.seed, Purpose::fibre_dither, random_index, chains.size());
            const double dither = options.dither ? random.uniform() : 0;
            chains.push_back({place_joints(curve, joints, dither), curve.period,
                              section.fibre_radius, system.kind});
        }
    }
    return chains;
}

/// A lower bound of the system's segments in the cell: what the turns of its axes alone ask for.
double fewest_segments(const YarnSystem& system, const YarnSystem& crossed,
                       const MicroElementOptions& options) {
    double turn = 0;
    for (const YarnAxis& axis : system.axes)
        turn += axis.turn();
    return turn * system.repeats * crossed.repeats * system.yarn->fibres /
           radians(options.max_turn_degrees);
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
