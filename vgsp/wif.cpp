#include "vgsp/draft.h"
#include "vgsp/wif_sections.h"

#include <algorithm>
#include <fmt/format.h>
#include <limits>
#include <map>
#include <optional>

// Weaving Information File 1.1 and 1.2, as weaving programs write it. The cloth's sett is not read:
// the spacings in drafts are boilerplate, often with threads thicker than their distance.

namespace rapport {
namespace {

/// Shafts and treadles, too, are never more than this.
constexpr int kMaxNumber = kMaxThreads;

/// Things of one kind to warn of once: how many, and where the first is.
struct Tally {
    int count = 0, first = 0, line = 0;
    void add(int number, int at_line) {
        if (count++ == 0)
            first = number, line = at_line;
    }
    std::string more() const {
        return count > 1 ? fmt::format(" (and {} more)", count - 1) : std::string();
    }
};

class WifReader {
  public:
    explicit WifReader(const std::filesystem::path& path) : file_(path) {}
    Draft read();

  private:
    int thread_count(const char* section, const char* things) const;
    std::optional<int> weaving_number(const char* key) const;
    bool rising_shed();
    std::vector<std::vector<int>> by_thread(const WifSection& section, int threads,
                                            const char* thread, const char* what) const;
    void warn_above(const std::vector<std::vector<int>>& lists, const WifSection& section,
                    std::optional<int> limit, const char* what, const char* key);
    void read_lifts();
    void raise(const std::vector<std::vector<int>>& threading);
    void read_palette();
    std::vector<int> thread_colours(const char* system, const char* section, int threads);
    int palette_index(int number, int line) const;

    WifFile file_;
    Draft draft_;
    std::map<int, std::vector<int>> tieup_;   ///< shafts by treadle
    std::vector<std::vector<int>> treadling_; ///< treadles by pick, or shafts by a liftplan
    bool liftplan_ = false;
    std::map<int, int> colours_; ///< number in the file → index into the palette
};

int WifReader::thread_count(const char* section, const char* things) const {
    const WifSection& threads = file_.require(section, fmt::format("with Threads, the {}", things));
    const WifEntry* const entry = file_.entry(&threads, "threads");
    if (!entry)
        file_.fail(threads.line, fmt::format("Threads=, the number of {}", things), "no such key");
    return file_.number(*entry, 1, kMaxThreads, fmt::format("a number of {}", things));
}

std::optional<int> WifReader::weaving_number(const char* key) const {
    const WifEntry* const entry = file_.entry(file_.find("weaving"), key);
    if (!entry)
        return std::nullopt;
    return file_.number(*entry, 0, kMaxNumber, "a number");
}

bool WifReader::rising_shed() {
    const WifSection* const weaving = file_.find("weaving");
    if (const WifEntry* const profile = file_.entry(weaving, "profile");
        profile && file_.boolean(*profile))
        draft_.warnings.push_back("a profile draft: each block is read as one end or pick");
    if (const WifEntry* const rising = file_.entry(weaving, "rising shed"))
        return file_.boolean(*rising);
    draft_.warnings.push_back("[WEAVING] does not say Rising Shed; taken as rising");
    return true;
}

/// The entries of a section by thread (index = number − 1), without the zeros that stand for none.
std::vector<std::vector<int>> WifReader::by_thread(const WifSection& section, int threads,
                                                   const char* thread, const char* what) const {
    std::vector<std::vector<int>> result(threads);
    for (WifList& list : file_.lists(section, 0, kMaxNumber, what)) {
        std::erase(list.values, 0);
        if (list.number <= threads)
            result[list.number - 1] = std::move(list.values);
        else if (!list.values.empty())
            file_.fail(list.line, fmt::format("{} 1 … {} in [{}]", thread, threads, section.name),
                       fmt::format("{} {}", thread, list.number));
    }
    return result;
}

void WifReader::warn_above(const std::vector<std::vector<int>>& lists, const WifSection& section,
                           std::optional<int> limit, const char* what, const char* key) {
    if (!limit)
        return;
    Tally above;
    for (const auto& list : lists)
        for (const int number : list)
            if (number > *limit)
                above.add(number, section.line);
    if (above.count)
        draft_.warnings.push_back(fmt::format("[{}] uses {} {}{}, above {}={}", section.name, what,
                                              above.first, above.more(), key, *limit));
}

/// Fills treadling_ and tieup_ from tie-up and treadling where both have entries, else from the
/// liftplan.
void WifReader::read_lifts() {
    const WifSection *const tieup = file_.find("tieup"), *const treadling = file_.find("treadling"),
                            *const liftplan = file_.find("liftplan");
    const auto filled = [](const WifSection* section) {
        return section && !section->entries.empty();
    };
    liftplan_ = liftplan && !(filled(tieup) && filled(treadling));
    if (liftplan_) {
        treadling_ = by_thread(*liftplan, draft_.picks, "pick", "a shaft");
        warn_above(treadling_, *liftplan, weaving_number("shafts"), "shaft", "Shafts");
        return;
    }
    if (!tieup && !treadling)
        file_.require("liftplan", "or the pair [TIEUP] and [TREADLING]");
    file_.require("tieup", "for the treadles of [TREADLING], or a [LIFTPLAN]");
    file_.require("treadling", "for the treadles of [TIEUP], or a [LIFTPLAN]");
    if (liftplan)
        draft_.warnings.push_back("[LIFTPLAN] is passed over for [TIEUP] and [TREADLING]");

    std::vector<std::vector<int>> tied;
    for (WifList& list : file_.lists(*tieup, 0, kMaxNumber, "a shaft")) {
        std::erase(list.values, 0);
        tied.push_back(list.values);
        tieup_[list.number] = std::move(list.values);
    }
    warn_above(tied, *tieup, weaving_number("shafts"), "shaft", "Shafts");

    // A treadle that [WEAVING] counts may be tied to nothing; any other must have its tie-up.
    const std::optional<int> treadles = weaving_number("treadles");
    Tally untied;
    for (const WifList& list : file_.lists(*treadling, 0, kMaxNumber, "a treadle"))
        for (const int treadle : list.values)
            if (treadle != 0 && !tieup_.contains(treadle)) {
                if (treadle > treadles.value_or(0))
                    file_.fail(list.line, "a treadle that [TIEUP] ties to shafts",
                               fmt::format("treadle {}", treadle));
                untied.add(treadle, list.line);
            }
    if (untied.count)
        draft_.warnings.push_back(fmt::format("line {}: treadle {} is tied to no shaft{}",
                                              untied.line, untied.first, untied.more()));
    treadling_ = by_thread(*treadling, draft_.picks, "pick", "a treadle");
    warn_above(treadling_, *treadling, treadles, "treadle", "Treadles");
}

/// The crossings, from the shafts of each end and the shafts that each pick lifts.
void WifReader::raise(const std::vector<std::vector<int>>& threading) {
    size_t threaded = 0;
    for (const auto& shafts : threading)
        threaded += shafts.size();
    const auto check = [&](size_t work) {
        if (work > size_t(kMaxCrossings))
            file_.fail(file_.find("threading")->line,
                       fmt::format("at most {} crossings of picks with entries of [THREADING] and "
                                   "shafts lifted in all",
                                   kMaxCrossings),
                       "more");
    };
    check(size_t(draft_.picks) * std::max(threaded, size_t(draft_.ends)));
    draft_.warp_up.assign(size_t(draft_.picks) * draft_.ends, 0);

    size_t lifts = 0;
    std::vector<int> lifted_at(kMaxNumber + 1, -1); // last pick that lifted the shaft
    for (int pick = 0; pick < draft_.picks; ++pick) {
        bool empty = true;
        const auto lift = [&](const std::vector<int>& shafts) {
            check(lifts += shafts.size() + 1);
            for (const int shaft : shafts)
                lifted_at[shaft] = pick;
            empty &= shafts.empty();
        };
        if (liftplan_) {
            lift(treadling_[pick]);
        } else {
            for (const int treadle : treadling_[pick])
                if (const auto tied = tieup_.find(treadle); tied != tieup_.end())
                    lift(tied->second);
        }
        if (empty) {
            draft_.empty_picks.push_back(pick);
            continue;
        }
        for (int end = 0; end < draft_.ends; ++end)
            draft_.set_up(end, pick,
                          std::any_of(threading[end].begin(), threading[end].end(),
                                      [&](int shaft) { return lifted_at[shaft] == pick; }));
    }
}

void WifReader::read_palette() {
    const WifSection* const table = file_.find("color table");
    if (!table)
        return;
    int low = 0, high = 255;
    const WifSection* const palette = file_.find("color palette");
    if (const WifEntry* const range = file_.entry(palette, "range")) {
        constexpr int kMaxColour = 65535;
        const std::vector<int> ends = file_.list(*range, 0, kMaxColour, "a colour value");
        if (ends.size() != 2 || ends[0] >= ends[1])
            file_.fail(range->line, "Range=low,high", fmt::format("{} values", ends.size()));
        low = ends[0], high = ends[1];
    } else {
        draft_.warnings.push_back("[COLOR PALETTE] has no Range; taken as 0,255");
    }
    std::map<int, std::array<double, 3>> colours;
    for (const WifList& list : file_.lists(*table, low, high, "a colour value")) {
        if (list.values.size() != 3)
            file_.fail(list.line, "red,green,blue", fmt::format("{} values", list.values.size()));
        for (int i = 0; i < 3; ++i)
            colours[list.number][i] = double(list.values[i] - low) / (high - low);
    }
    for (const auto& [number, colour] : colours) {
        colours_[number] = int(draft_.palette.size());
        draft_.palette.push_back(colour);
        draft_.palette_numbers.push_back(number);
    }
}

int WifReader::palette_index(int number, int line) const {
    const auto found = colours_.find(number);
    if (found == colours_.end())
        file_.fail(line, "a colour of [COLOR TABLE]",
                   colours_.empty() ? fmt::format("colour {} and no such table", number)
                                    : fmt::format("colour {}", number));
    return found->second;
}

/// The palette index of each thread, from `section` and, for those not in it, the Color of
/// `system`; empty if neither says anything.
std::vector<int> WifReader::thread_colours(const char* system, const char* section, int threads) {
    // Old files write a colour as index,red,green,blue, with 0 for none.
    constexpr int kMaxColourValue = std::numeric_limits<int>::max();
    int fallback = -1;
    if (const WifEntry* const color = file_.entry(file_.find(system), "color")) {
        const std::vector<int> values = file_.list(*color, 0, kMaxColourValue, "a colour");
        if (!values.empty() && values[0] != 0)
            fallback = palette_index(values[0], color->line);
    }
    std::vector<int> colours(threads, fallback);
    if (const WifSection* const listed = file_.find(section))
        for (const WifList& list : file_.lists(*listed, 0, kMaxColourValue, "a colour"))
            if (!list.values.empty() && list.values[0] != 0) {
                const int index = palette_index(list.values[0], list.line);
                if (list.number <= threads)
                    colours[list.number - 1] = index;
            }
    const auto without = std::count(colours.begin(), colours.end(), -1);
    if (without == threads)
        return {};
    if (without > 0) {
        draft_.warnings.push_back(
            fmt::format("{} of {} threads of the {} have no colour; taken as the first of the "
                        "[COLOR TABLE]",
                        without, threads, system));
        std::replace(colours.begin(), colours.end(), -1, 0);
    }
    return colours;
}

Draft WifReader::read() {
    const WifSection& threading_section = file_.require("threading", "for the shaft of each end");
    draft_.ends = thread_count("warp", "ends");
    draft_.picks = thread_count("weft", "picks");
    if (int64_t(draft_.ends) * draft_.picks > kMaxCrossings)
        file_.fail(file_.entry(file_.find("weft"), "threads")->line,
                   fmt::format("at most {} crossings", kMaxCrossings),
                   fmt::format("{} ends by {} picks", draft_.ends, draft_.picks));
    const bool rising = rising_shed();

    const auto threading = by_thread(threading_section, draft_.ends, "end", "a shaft");
    warn_above(threading, threading_section, weaving_number("shafts"), "shaft", "Shafts");
    for (int end = 0; end < draft_.ends; ++end)
        if (threading[end].empty())
            draft_.unthreaded_ends.push_back(end);
    read_lifts();
    raise(threading);
    if (!rising)
        for (uint8_t& up : draft_.warp_up)
            up = !up;
    if (const auto& ends = draft_.unthreaded_ends; !ends.empty())
        draft_.warnings.push_back(fmt::format("{} of {} ends are on no shaft; the first is end {}",
                                              ends.size(), draft_.ends, ends[0] + 1));
    if (const auto& picks = draft_.empty_picks; !picks.empty())
        draft_.warnings.push_back(fmt::format("{} of {} picks raise nothing; the first is pick {}",
                                              picks.size(), draft_.picks, picks[0] + 1));
    read_palette();
    draft_.warp_colours = thread_colours("warp", "warp colors", draft_.ends);
    draft_.weft_colours = thread_colours("weft", "weft colors", draft_.picks);
    return std::move(draft_);
}

} // namespace

Draft read_wif(const std::filesystem::path& path) { return WifReader(path).read(); }

} // namespace rapport
