#include "vgsp/weave.h"

#include "renderer/core/error.h"

#include <algorithm>
#include <cstring>
#include <fmt/format.h>
#include <numeric>

namespace rapport {
namespace {

/// The numbers 0 … count − 1 without those in `dropped`.
std::vector<int> others(int count, const std::vector<int>& dropped) {
    std::vector<int> all(count), kept;
    std::iota(all.begin(), all.end(), 0);
    std::set_difference(all.begin(), all.end(), dropped.begin(), dropped.end(),
                        std::back_inserter(kept));
    return kept;
}

std::vector<int> chosen(const std::vector<int>& values, const std::vector<int>& indices) {
    std::vector<int> result;
    if (!values.empty())
        for (const int i : indices)
            result.push_back(values[i]);
    return result;
}

/// The draft with only these ends and picks; nothing else of it changes.
Draft cut(const Draft& draft, const std::vector<int>& ends, const std::vector<int>& picks) {
    Draft result;
    result.ends = int(ends.size());
    result.picks = int(picks.size());
    result.warp_up.reserve(ends.size() * picks.size());
    for (const int pick : picks)
        for (const int end : ends)
            result.warp_up.push_back(draft.up(end, pick));
    result.warp_colours = chosen(draft.warp_colours, ends);
    result.weft_colours = chosen(draft.weft_colours, picks);
    result.palette = draft.palette;
    result.palette_numbers = draft.palette_numbers;
    result.warp_yarns = chosen(draft.warp_yarns, ends);
    result.weft_yarns = chosen(draft.weft_yarns, picks);
    result.warnings = draft.warnings;
    return result;
}

[[noreturn]] void fail_infinite_float(const std::string& path, const char* thread, int number,
                                      const char* crossed, bool over) {
    throw FileError(path, fmt::format("{} {}", thread, number),
                    fmt::format("a crossing over and one under a {}", crossed),
                    fmt::format("an infinite float {} every {}", over ? "over" : "under", crossed));
}

/// `ends` and `picks` are the places of the draft's threads in the draft that the message is about.
void check_interlacing(const Draft& draft, const std::vector<int>& ends,
                       const std::vector<int>& picks, const std::string& path) {
    std::vector<int> end_ups(draft.ends, 0);
    std::vector<int> pick_ups(draft.picks, 0);
    for (int pick = 0; pick < draft.picks; ++pick)
        for (int end = 0; end < draft.ends; ++end) {
            end_ups[end] += draft.up(end, pick);
            pick_ups[pick] += draft.up(end, pick);
        }
    for (int end = 0; end < draft.ends; ++end)
        if (end_ups[end] == 0 || end_ups[end] == draft.picks)
            fail_infinite_float(path, "end", ends[end] + 1, "pick", end_ups[end] != 0);
    for (int pick = 0; pick < draft.picks; ++pick)
        if (pick_ups[pick] == 0 || pick_ups[pick] == draft.ends)
            fail_infinite_float(path, "pick", picks[pick] + 1, "end", pick_ups[pick] == 0);
}

template <class T> bool repeats_after(const T* values, int count, int period) {
    return std::memcmp(values, values + period, sizeof(T) * (count - period)) == 0;
}

/// True as well for a property that the draft does not tell.
bool repeats_after(const std::vector<int>& values, int period) {
    return values.empty() || repeats_after(values.data(), int(values.size()), period);
}

bool ends_repeat_after(const Draft& draft, int period) {
    if (!repeats_after(draft.warp_colours, period) || !repeats_after(draft.warp_yarns, period))
        return false;
    for (int pick = 0; pick < draft.picks; ++pick)
        if (!repeats_after(&draft.warp_up[size_t(pick) * draft.ends], draft.ends, period))
            return false;
    return true;
}

bool picks_repeat_after(const Draft& draft, int period) {
    if (!repeats_after(draft.weft_colours, period) || !repeats_after(draft.weft_yarns, period))
        return false;
    const size_t row = draft.ends;
    return std::memcmp(draft.warp_up.data(), draft.warp_up.data() + row * period,
                       row * (draft.picks - period)) == 0;
}

/// The smallest divisor of `count` that is a period. Periods that divide `count` are closed under
/// the greatest common divisor, so taking out one prime factor at a time finds it.
template <class IsPeriod> int smallest_period(int count, IsPeriod is_period) {
    int period = count;
    int rest = count;
    for (int factor = 2; rest > 1; ++factor)
        for (; rest % factor == 0; rest /= factor)
            if (is_period(period / factor))
                period /= factor;
    return period;
}

} // namespace

Draft tiled(const Draft& draft, int ends, int picks) {
    const auto again = [](int count, int period) {
        std::vector<int> indices(count);
        for (int i = 0; i < count; ++i)
            indices[i] = i % period;
        return indices;
    };
    return cut(draft, again(ends, draft.ends), again(picks, draft.picks));
}

Draft weavable(const Draft& draft, const std::string& path) {
    const std::vector<int> ends = others(draft.ends, draft.unthreaded_ends);
    const std::vector<int> picks = others(draft.picks, draft.empty_picks);
    if (ends.empty() || picks.empty())
        throw FileError(path, "", "ends and picks that interlace",
                        ends.empty() ? "no end on a shaft" : "no pick that raises a shaft");
    Draft woven = cut(draft, ends, picks);
    if (woven.ends < draft.ends || woven.picks < draft.picks)
        woven.warnings.push_back(fmt::format(
            "woven without its {} unthreaded ends and {} empty picks: {} × {} are left",
            draft.ends - woven.ends, draft.picks - woven.picks, woven.ends, woven.picks));
    check_interlacing(woven, ends, picks, path);

    const int repeat_ends =
        smallest_period(woven.ends, [&](int period) { return ends_repeat_after(woven, period); });
    const int repeat_picks =
        smallest_period(woven.picks, [&](int period) { return picks_repeat_after(woven, period); });
    return cut(woven, others(repeat_ends, {}), others(repeat_picks, {}));
}

} // namespace rapport
