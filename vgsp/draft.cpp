#include "vgsp/draft.h"

#include <algorithm>
#include <cctype>
#include <charconv>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <functional>
#include <numeric>
#include <optional>

namespace rapport {
namespace {

constexpr std::string_view kNamedWeaves =
    R"("plain", "twill a/b Z", "twill a/b S", "satin n/s", "sateen n/s" or "basket n")";
/// Longest repeat of a named weave, in ends.
constexpr int kMaxNamedRepeat = 1000;

Draft square_repeat(int n, const std::function<bool(int end, int pick)>& up) {
    Draft draft;
    draft.ends = draft.picks = n;
    draft.warp_up.resize(size_t(n) * n);
    for (int pick = 0; pick < n; ++pick)
        for (int end = 0; end < n; ++end)
            draft.set_up(end, pick, up(end, pick));
    return draft;
}

std::vector<std::string> lower_case_words(std::string_view text) {
    std::vector<std::string> words;
    bool in_word = false;
    for (const unsigned char c : text) {
        if (std::isspace(c)) {
            in_word = false;
            continue;
        }
        if (!in_word)
            words.emplace_back();
        in_word = true;
        words.back() += char(std::tolower(c));
    }
    return words;
}

/// A whole number of 1 … kMaxNamedRepeat, digits only.
std::optional<int> count_in(std::string_view text) {
    int value = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc() || end != text.data() + text.size() || value < 1 ||
        value > kMaxNamedRepeat)
        return std::nullopt;
    return value;
}

std::optional<std::pair<int, int>> two_counts_in(std::string_view text) {
    const size_t slash = text.find('/');
    if (slash == text.npos)
        return std::nullopt;
    const auto first = count_in(text.substr(0, slash)), second = count_in(text.substr(slash + 1));
    if (!first || !second)
        return std::nullopt;
    return std::pair(*first, *second);
}

/// The moves of a regular satin on n ends: coprime to n, and neither 1 nor n − 1, which are twills.
std::vector<int> satin_moves(int n) {
    std::vector<int> moves;
    for (int move = 2; move < n - 1; ++move)
        if (std::gcd(move, n) == 1)
            moves.push_back(move);
    return moves;
}

/// The place where satin's rarer yarn comes to the top, by pick; throws for an irregular satin.
Draft satin(int n, int move, bool warp_faced, const std::string& found) {
    const std::vector<int> moves = satin_moves(n);
    const char* const name = warp_faced ? "satin" : "sateen";
    if (moves.empty())
        throw InvalidWeave(fmt::format("a {} on 5 ends or on 7 and more", name), found);
    if (std::find(moves.begin(), moves.end(), move) == moves.end())
        throw InvalidWeave(fmt::format("a {0} {1}/s with a move s of {2} (2 … {1} − 2 with no "
                                       "factor in common with {1})",
                                       name, n, fmt::join(moves, ", ")),
                           found);
    return square_repeat(n,
                         [=](int end, int pick) { return (end == pick * move % n) != warp_faced; });
}

} // namespace

InvalidWeave::InvalidWeave(const std::string& expected, const std::string& found)
    : std::invalid_argument(fmt::format("expected {}, found {}", expected, found)),
      expected(expected), found(found) {}

Draft named_weave(std::string_view name) {
    const std::string found = fmt::format("\"{}\"", name);
    const std::vector<std::string> words = lower_case_words(name);
    const std::string kind = words.empty() ? std::string() : words[0];

    if (kind == "plain" && words.size() == 1)
        return square_repeat(2, [](int end, int pick) { return (end + pick) % 2 == 0; });
    if (kind == "twill") {
        const auto floats = words.size() == 3 ? two_counts_in(words[1]) : std::nullopt;
        if (!floats || (words[2] != "z" && words[2] != "s"))
            throw InvalidWeave(R"("twill a/b Z" or "twill a/b S": over a picks, under b)", found);
        const auto [over, under] = *floats;
        const int n = over + under;
        const int step = words[2] == "z" ? n - 1 : 1;
        return square_repeat(
            n, [=, over = over](int end, int pick) { return (end + step * pick) % n < over; });
    }
    if (kind == "satin" || kind == "sateen") {
        const auto counts = words.size() == 2 ? two_counts_in(words[1]) : std::nullopt;
        if (!counts)
            throw InvalidWeave(fmt::format("\"{} n/s\": n ends, move s", kind), found);
        return satin(counts->first, counts->second, kind == "satin", found);
    }
    if (kind == "basket") {
        const auto size = words.size() == 2 ? count_in(words[1]) : std::nullopt;
        if (!size || *size < 2 || 2 * *size > kMaxNamedRepeat)
            throw InvalidWeave(fmt::format("\"basket n\" with n of 2 … {}", kMaxNamedRepeat / 2),
                               found);
        return square_repeat(
            2 * *size, [n = *size](int end, int pick) { return (end / n + pick / n) % 2 == 0; });
    }
    throw InvalidWeave(std::string(kNamedWeaves), found);
}

Draft draft_from_rows(const std::vector<std::string>& rows) {
    if (rows.empty() || rows[0].empty())
        throw InvalidWeave("rows of '0' and '1', one for each pick", "none");
    const size_t ends = rows[0].size(), picks = rows.size();
    if (ends > size_t(kMaxThreads) || picks > size_t(kMaxThreads) ||
        ends * picks > size_t(kMaxCrossings))
        throw InvalidWeave(fmt::format("at most {} ends, {} picks and {} crossings", kMaxThreads,
                                       kMaxThreads, kMaxCrossings),
                           fmt::format("{} ends and {} picks", ends, picks));
    Draft draft;
    draft.ends = int(ends);
    draft.picks = int(picks);
    draft.warp_up.reserve(ends * picks);
    for (size_t pick = 0; pick < picks; ++pick) {
        if (rows[pick].size() != ends)
            throw InvalidWeave(fmt::format("rows of {} crossings each, as the first", ends),
                               fmt::format("{} in row {}", rows[pick].size(), pick + 1));
        for (const char c : rows[pick]) {
            if (c != '0' && c != '1')
                throw InvalidWeave("rows of '0' (weft up) and '1' (warp up)",
                                   fmt::format("another character in row {}", pick + 1));
            draft.warp_up.push_back(c == '1');
        }
    }
    return draft;
}

std::vector<std::string> draft_rows(const Draft& draft) {
    std::vector<std::string> rows(draft.picks, std::string(draft.ends, '0'));
    for (int pick = 0; pick < draft.picks; ++pick)
        for (int end = 0; end < draft.ends; ++end)
            if (draft.up(end, pick))
                rows[pick][end] = '1';
    return rows;
}

} // namespace rapport
