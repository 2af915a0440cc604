#include "vgsp/yarn_system.h"

#include "renderer/core/error.h"
#include "renderer/core/math.h"
#include "vgsp/yarn_settling.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

namespace rapport {
namespace {

constexpr int kMaxRepeats = 64;       ///< of the draft that twist may ask for, along the yarns
constexpr double kRounding = 1e-9;    ///< relative; what a length that just suffices may lack
constexpr double kMaxRounding = 0.02; ///< relative change of a twist

/// Refuses a migration whose bends round fibres could not follow.
void check_irregularity(const YarnSpec& yarn, const std::string& path, const std::string& place) {
    const Irregularity& irregularity = yarn.irregularity;
    const double smallest = 2 * yarn.fibre.diameter_um;
    if (!(irregularity.correlation_length_um() >= smallest * (1 - kRounding)))
        throw FileError(path, place,
                        fmt::format("a migration_um of at least {:.3g} for deviation_degrees {:g} "
                                    "(a correlation length of two fibre diameters)",
                                    smallest * std::tan(radians(irregularity.deviation_degrees)),
                                    irregularity.deviation_degrees),
                        fmt::format("{:g}", irregularity.migration_um));
}

/// `named` has the named yarn of each thread, or is empty for `threads` of the kind called `name`.
YarnSystem make_system(const Cloth& cloth, const char* name, const char* sett_name, double sett,
                       const std::vector<int>& named, int threads) {
    const std::string path = cloth.path.string();
    YarnSystem system;
    system.name = name;
    system.sett_name = sett_name;
    if (!(sett > 0 && std::isfinite(sett)))
        throw FileError(path, system.sett_name, "a positive sett", fmt::format("{:g}", sett));
    system.spacing = 1e4 / sett;

    const std::vector<YarnKind> kinds = yarn_kinds(cloth);
    const size_t first_named = kinds.size() - cloth.yarns.size();
    for (int thread = 0; thread < threads; ++thread) {
        size_t kind = 0;
        if (!named.empty())
            kind = first_named + size_t(named[thread]);
        else
            while (kinds[kind].place != name)
                ++kind;
        const auto known = std::find_if(system.kinds.begin(), system.kinds.end(),
                                        [&](const SystemYarn& k) { return k.kind == kind; });
        system.kind_of.push_back(int(known - system.kinds.begin()));
        if (known != system.kinds.end())
            continue;
        const auto& [place, yarn] = kinds[kind];
        system.kinds.push_back({uint32_t(kind), place, yarn, lay_out_section(*yarn, path, place)});
        check_irregularity(*yarn, path, place);
    }
    for (size_t k = 0; k < system.kinds.size(); ++k)
        system.kinds[k].share =
            double(std::count(system.kind_of.begin(), system.kind_of.end(), int(k))) / threads;
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

/// Refuses yarns that are wider than they are apart.
void check_width(const YarnSystem& system, const Cloth& cloth) {
    for (size_t i = 0; i < system.kind_of.size(); ++i) {
        const double width = system.yarn(i).half_width() + system.yarn(i + 1).half_width();
        if (width > system.spacing * (1 + kRounding))
            throw FileError(
                cloth.path.string(), system.sett_name,
                fmt::format("{} for a {} yarn {:.4g} µm wide (yarns too thick for the sett)",
                            largest_sett(width), system.name, width),
                fmt::format("{:g}", 1e4 / system.spacing));
    }
}

/// Relative change of the twist that makes `repeats` repeats close.
double rounding_of(double turns_per_repeat, int repeats) {
    const double turns = turns_per_repeat * repeats;
    return turns == 0 ? 0 : std::round(turns) / turns - 1;
}

/// The fewest repeats of the draft, from system.repeats on, after which every yarn's twists,
/// changed by at most 2 %, have turned the packing onto itself.
void close_twist(YarnSystem& system, const Cloth& cloth) {
    const SystemYarn* worst = &system.kinds[0];
    const auto rounding = [&] {
        double largest = 0;
        for (size_t i = 0; i < system.axes.size(); ++i) {
            const SymmetryTurns turns = symmetry_turns(system.yarn(i), system.axes[i]);
            for (const double per_repeat : {turns.packing, turns.plies}) {
                const double change = rounding_of(per_repeat, system.repeats);
                if (std::abs(change) > std::abs(largest)) {
                    largest = change;
                    worst = &system.yarn(i);
                }
            }
        }
        return largest;
    };
    while (std::abs(system.twist_rounding = rounding()) > kMaxRounding)
        if (++system.repeats > kMaxRepeats)
            throw FileError(cloth.path.string(), worst->place,
                            fmt::format("a twist that turns the packing onto itself within {} "
                                        "repeats of the draft (or twist_per_m = 0)",
                                        kMaxRepeats),
                            fmt::format("twist_per_m = {:g}", worst->yarn->twist_per_m));
}

} // namespace

std::string largest_sett(double spacing) {
    return fmt::format("at most {:.2f}", std::floor(1e6 / spacing) / 100);
}

double YarnSystem::mean_half_width() const {
    double mean = 0;
    for (const SystemYarn& yarn : kinds)
        mean += yarn.share * yarn.half_width();
    return mean;
}

double YarnSystem::greatest_height() const {
    double greatest = 0;
    for (size_t i = 0; i < axes.size(); ++i)
        greatest = std::max(greatest,
                            std::max(axes[i].highest(), -axes[i].lowest()) + yarn(i).half_height());
    return greatest;
}

double YarnSystem::mean_crimp() const {
    double sum = 0;
    for (const YarnAxis& axis : axes)
        sum += axis.length() / axis.period() - 1;
    return sum / axes.size();
}

SymmetryTurns symmetry_turns(const SystemYarn& yarn, const YarnAxis& axis) {
    const YarnSpec& spec = *yarn.yarn;
    const bool winds = spec.section != YarnSection::parallel && spec.fibres > 1;
    return {winds ? spec.twist_per_m * 1e-6 * axis.length() * yarn.section.symmetry : 0,
            spec.ply_twist_per_m * 1e-6 * axis.length() * spec.plies};
}

YarnSystems lay_systems(const Cloth& cloth, const Draft& draft, int least_repeats) {
    YarnSystem warp =
        make_system(cloth, "warp", "ends_per_cm", cloth.ends_per_cm, draft.warp_yarns, draft.ends);
    YarnSystem weft = make_system(cloth, "weft", "picks_per_cm", cloth.picks_per_cm,
                                  draft.weft_yarns, draft.picks);
    interlace(draft, warp, weft);
    check_width(warp, cloth);
    check_width(weft, cloth);
    settle(cloth, warp, weft);
    warp.repeats = weft.repeats = least_repeats;
    close_twist(warp, cloth);
    close_twist(weft, cloth);
    return {std::move(warp), std::move(weft)};
}

} // namespace rapport
