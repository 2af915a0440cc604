#include "vgsp/yarn_settling.h"

#include "renderer/core/error.h"
#include "renderer/core/math.h"
#include "vgsp/crossing_lift.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <optional>
#include <stdexcept>

namespace rapport {
namespace {

constexpr double kSettled = 1e-4;  ///< relative change of the separations that counts as none
constexpr double kStraight = 1e-6; ///< bend of a yarn, in parts of its height, that is none
constexpr int kMostSettlings = 30;
constexpr double kLiftStep = 1.0 / 256; ///< to which the lift is found that the setts have room for

using Wraps = std::vector<std::vector<std::shared_ptr<const WrapArc>>>; // [own kind][crossed kind]

Wraps wraps_of(const YarnSystem& system, const YarnSystem& crossed) {
    Wraps wraps;
    for (const SystemYarn& yarn : system.kinds) {
        auto& about = wraps.emplace_back();
        for (const SystemYarn& other : crossed.kinds)
            about.push_back(
                std::make_shared<WrapArc>(WrapCurve(other.section.outline, yarn.half_height())));
    }
    return wraps;
}

/// How high the axis of one yarn lies over that of another which it crosses, touching it: those of
/// straight elliptic cylinders, whose sections stand across them, inclined by `slope` and
/// `other_slope`. With n the normal of both axes, it is what they reach along n over n's height.
double clearance(const SectionOutline& yarn, double slope, const SectionOutline& other,
                 double other_slope) {
    return std::hypot(yarn.half_width * std::tan(other_slope), yarn.half_height / std::cos(slope)) +
           std::hypot(other.half_width * std::tan(slope),
                      other.half_height / std::cos(other_slope));
}

/// The crossings of yarn `index` with crossed yarns, whose axis is to pass at heights[k] over each
/// at about slopes[k]. Where it bends away from the yarn it crosses, which is possible because
/// each lies on the other, it bends as if round such a yarn on its other side.
std::vector<YarnAxis::Crossing> crossings_at(const YarnSystem& system, size_t index,
                                             const YarnSystem& crossed, const Wraps& wraps,
                                             const std::vector<double>& heights,
                                             const std::vector<double>& slopes) {
    const size_t count = heights.size();
    const double straight = kStraight * system.yarn(index).half_height();
    std::vector<YarnAxis::Crossing> crossings;
    for (size_t k = 0; k < count; ++k) {
        const double bend =
            2 * heights[k] - heights[(k + count - 1) % count] - heights[(k + 1) % count];
        const bool above = std::abs(bend) > straight ? bend > 0 : system.above[index][k] != 0;
        const auto& wrap = wraps[system.kind_of[index]][crossed.kind_of[k]];
        const double over = wrap->curve().support(slopes[k]) / std::cos(slopes[k]);
        crossings.push_back({above, heights[k] - (above ? over : -over), wrap});
    }
    return crossings;
}

/// Crossed yarns that leave one no way from above the one to below the next.
struct TooClose {
    double smallest; ///< spacing that would leave one [µm]
    double spacing;  ///< that there is
    const char* sett_name;
    std::string to_pass;

    std::string expected() const {
        return fmt::format("{} for {} (yarns too thick for the sett)", largest_sett(smallest),
                           to_pass);
    }
};

/// The closest of the crossed yarns.
TooClose too_close(const std::vector<YarnAxis::Crossing>& crossings, const YarnSystem& system,
                   size_t index, const YarnSystem& crossed) {
    double smallest = 0;
    size_t closest = 0;
    for (size_t k = 0; k < crossings.size(); ++k) {
        const YarnAxis::Crossing &from = crossings[k], &to = crossings[(k + 1) % crossings.size()];
        const double needed = WrapPassage({&from.wrap->curve(), from.above},
                                          {&to.wrap->curve(), to.above}, to.centre - from.centre)
                                  .smallest_spacing();
        if (needed > smallest) {
            smallest = needed;
            closest = k;
        }
    }
    const SystemYarn &a = crossed.yarn(closest), &b = crossed.yarn(closest + 1);
    return {smallest, crossed.spacing, crossed.sett_name.c_str(),
            fmt::format("a {} yarn {:.4g} µm thick to pass between {} yarns {:.4g} µm × {:.4g} µm",
                        system.name, 2 * system.yarn(index).half_height(), crossed.name,
                        a.half_width() + b.half_width(), a.half_height() + b.half_height())};
}

/// The slopes of the yarns' axes over their crossings: [yarn][crossing].
using Slopes = std::vector<std::vector<double>>;

Slopes slopes_of(const YarnSystem& system) {
    Slopes slopes;
    for (const YarnAxis& axis : system.axes)
        slopes.push_back(axis.crossing_slopes());
    return slopes;
}

std::optional<TooClose> lay_axes(YarnSystem& system, const YarnSystem& crossed, const Wraps& wraps,
                                 const std::vector<std::vector<double>>& heights,
                                 const Slopes& slopes) {
    system.axes.clear();
    for (size_t i = 0; i < heights.size(); ++i) {
        const auto crossings = crossings_at(system, i, crossed, wraps, heights[i], slopes[i]);
        try {
            system.axes.emplace_back(crossings, crossed.spacing);
        } catch (const std::invalid_argument&) {
            return too_close(crossings, system, i, crossed);
        }
    }
    return std::nullopt;
}

/// The heights of ends [end][pick] and picks [pick][end] with `share` of the lift, from the middle
/// of the yarns' outlines.
std::pair<std::vector<std::vector<double>>, std::vector<std::vector<double>>>
heights_of(const std::vector<double>& separation, const std::vector<double>& lift, double share,
           double balance, const YarnSystem& warp, const YarnSystem& weft) {
    const size_t ends = warp.above.size(), picks = weft.above.size();
    std::vector<std::vector<double>> of_ends(ends, std::vector<double>(picks)),
        of_picks(picks, std::vector<double>(ends));
    double highest = -HUGE_VAL, lowest = HUGE_VAL;
    for (size_t end = 0; end < ends; ++end)
        for (size_t pick = 0; pick < picks; ++pick) {
            const size_t crossing = end * picks + pick;
            const double lifted = share * lift[crossing];
            of_ends[end][pick] = balance * separation[crossing] + lifted;
            of_picks[pick][end] = (balance - 1) * separation[crossing] + lifted;
            for (const auto& [height, reach] :
                 {std::pair(of_ends[end][pick], warp.yarn(end).half_height()),
                  std::pair(of_picks[pick][end], weft.yarn(pick).half_height())}) {
                highest = std::max(highest, height + reach);
                lowest = std::min(lowest, height - reach);
            }
        }
    for (auto* system : {&of_ends, &of_picks})
        for (std::vector<double>& yarn : *system)
            for (double& height : yarn)
                height -= 0.5 * (highest + lowest);
    return {std::move(of_ends), std::move(of_picks)};
}

/// Lays the yarns with `share` of the lift, or tells where there is no room for it.
std::optional<TooClose> settle_lifted(YarnSystem& warp, YarnSystem& weft, const Wraps& of_warp,
                                      const Wraps& of_weft, double balance, double share) {
    const size_t ends = warp.above.size(), picks = weft.above.size();
    Slopes warp_slopes(ends, std::vector<double>(picks)),
        weft_slopes(picks, std::vector<double>(ends));
    std::vector<double> separation(ends * picks), lift(ends * picks);
    for (int settling = 0; settling < kMostSettlings; ++settling) {
        double change = 0, greatest = 0; // of the separations
        for (size_t end = 0; end < ends; ++end)
            for (size_t pick = 0; pick < picks; ++pick) {
                const double apart =
                    clearance(warp.yarn(end).section.outline, warp_slopes[end][pick],
                              weft.yarn(pick).section.outline, weft_slopes[pick][end]);
                double& at = separation[end * picks + pick];
                change = std::max(change, std::abs(std::abs(at) - apart));
                greatest = std::max(greatest, apart);
                at = warp.above[end][pick] ? apart : -apart;
            }
        if (change <= kSettled * greatest)
            break;
        if (share > 0)
            lift = crossing_lift(separation, int(ends), int(picks), balance, std::move(lift));
        const auto [of_ends, of_picks] = heights_of(separation, lift, share, balance, warp, weft);
        if (auto too_close = lay_axes(warp, weft, of_warp, of_ends, warp_slopes))
            return too_close;
        if (auto too_close = lay_axes(weft, warp, of_weft, of_picks, weft_slopes))
            return too_close;
        warp_slopes = slopes_of(warp);
        weft_slopes = slopes_of(weft);
    }
    return std::nullopt;
}

} // namespace

void settle(const Cloth& cloth, YarnSystem& warp, YarnSystem& weft) {
    const Wraps of_warp = wraps_of(warp, weft), of_weft = wraps_of(weft, warp);
    const auto lifted_by = [&](double share) {
        return settle_lifted(warp, weft, of_warp, of_weft, cloth.crimp_balance, share);
    };
    const std::optional<TooClose> lifted = lifted_by(1);
    if (!lifted)
        return;
    if (const std::optional<TooClose> flat = lifted_by(0)) {
        const TooClose& nearer =
            flat->smallest / flat->spacing < lifted->smallest / lifted->spacing ? *flat : *lifted;
        throw FileError(cloth.path.string(), nearer.sett_name, nearer.expected(),
                        fmt::format("{:g}", 1e4 / nearer.spacing));
    }
    double low = 0, high = 1;
    while (high - low > kLiftStep) {
        const double middle = 0.5 * (low + high);
        (lifted_by(middle) ? high : low) = middle;
    }
    lifted_by(low);
}

} // namespace rapport
