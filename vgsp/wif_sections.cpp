#include "vgsp/wif_sections.h"

#include "renderer/core/error.h"
#include "renderer/core/input_file.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <fmt/format.h>
#include <limits>
#include <string_view>
#include <unordered_map>

namespace rapport {
namespace {

/// Larger than any draft of kMaxThreads ends and picks.
constexpr uint64_t kMaxFileBytes = 32 << 20;

constexpr std::array kSectionsRead = {
    "WIF",       "WEAVING",       "WARP",        "WEFT",        "THREADING", "TIEUP",
    "TREADLING", "COLOR PALETTE", "COLOR TABLE", "WARP COLORS", "LIFTPLAN",  "WEFT COLORS",
};

std::string_view trimmed(std::string_view text) {
    constexpr std::string_view kSpace = " \t\v\f";
    const size_t first = text.find_first_not_of(kSpace);
    if (first == text.npos)
        return {};
    return text.substr(first, text.find_last_not_of(kSpace) - first + 1);
}

std::string lower_case(std::string_view text) {
    std::string result(text);
    for (char& c : result)
        c = char(std::tolower(static_cast<unsigned char>(c)));
    return result;
}

std::string_view without_comment(std::string_view text) {
    return trimmed(text.substr(0, text.find(';')));
}

/// For a message of one line: short, and printable whatever the bytes were.
std::string excerpt(std::string_view text) {
    constexpr size_t kLongest = 40;
    std::string result = "\"";
    for (const unsigned char c : text.substr(0, kLongest))
        result += c >= 0x20 && c < 0x7f ? char(c) : '?';
    return result + (text.size() > kLongest ? "…\"" : "\"");
}

std::optional<int> whole_number(std::string_view text) {
    int value = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc() || end != text.data() + text.size())
        return std::nullopt;
    return value;
}

std::string range_text(int low, int high, const std::string& what) {
    return high == std::numeric_limits<int>::max() ? fmt::format("{} of {} or more", what, low)
                                                   : fmt::format("{} of {} … {}", what, low, high);
}

std::string read_text(const std::filesystem::path& path) {
    InputFile file = open_input(path);
    if (file.size > kMaxFileBytes)
        throw FileError(path.string(), "",
                        fmt::format("a draft of at most {} bytes", kMaxFileBytes),
                        fmt::format("{}", file.size));
    std::string text(file.size, '\0');
    file.stream.read(text.data(), std::streamsize(text.size()));
    if (uint64_t(file.stream.gcount()) != file.size)
        throw FileError(path.string(), "", "a file that can be read to its end",
                        "an end before its size");
    if (text.starts_with("\xEF\xBB\xBF"))
        text.erase(0, 3);
    if (text.starts_with("\xFF\xFE") || text.starts_with("\xFE\xFF"))
        throw FileError(path.string(), 1, "text in single bytes or UTF-8", "UTF-16");
    return text;
}

} // namespace

WifFile::WifFile(const std::filesystem::path& path) : path_(path.string()) {
    const std::string text = read_text(path);
    WifSection none;
    none.name = "none";
    WifSection* section = &none; // nullptr while in a section that is passed over
    int number = 0;
    for (size_t start = 0; start < text.size();) {
        const size_t end = std::min(text.find_first_of("\r\n", start), text.size());
        read_line(text.substr(start, end - start), ++number, section);
        start = end + (text.compare(end, 2, "\r\n") == 0 ? 2 : 1);
    }
    last_line_ = std::max(number, 1);
}

void WifFile::read_line(const std::string& raw, int number, WifSection*& section) {
    const std::string_view line = trimmed(raw);
    if (line.starts_with('[')) {
        const size_t close = line.find(']');
        const bool header = close != line.npos && without_comment(line.substr(close + 1)).empty();
        if (header) {
            const std::string name = lower_case(trimmed(line.substr(1, close - 1)));
            const auto spelling =
                std::find_if(kSectionsRead.begin(), kSectionsRead.end(),
                             [&](const char* known) { return lower_case(known) == name; });
            if (spelling == kSectionsRead.end()) {
                section = nullptr;
                return;
            }
            const auto [place, added] =
                sections_.try_emplace(name, WifSection{*spelling, number, {}});
            section = &place->second;
            if (!added)
                fail(number, fmt::format("one section [{}]", section->name),
                     fmt::format("a second; the first is on line {}", section->line));
            return;
        }
    }
    if (!section || line.empty() || line.starts_with(';'))
        return;
    const size_t equals = line.find('=');
    if (section->line == 0)
        fail(number, "a [SECTION] header", excerpt(line));
    if (equals == line.npos || line.starts_with('['))
        fail(number, fmt::format("key=value, a comment or a header in [{}]", section->name),
             excerpt(line));
    section->entries.push_back({lower_case(trimmed(line.substr(0, equals))),
                                std::string(trimmed(line.substr(equals + 1))), number});
}

const WifSection* WifFile::find(const std::string& name) const {
    const auto found = sections_.find(name);
    return found == sections_.end() ? nullptr : &found->second;
}

const WifSection& WifFile::require(const std::string& name, const std::string& purpose) const {
    if (const WifSection* section = find(name))
        return *section;
    std::string header = name;
    for (char& c : header)
        c = char(std::toupper(static_cast<unsigned char>(c)));
    fail(last_line_, fmt::format("a section [{}] {}", header, purpose), "the end of the file");
}

const WifEntry* WifFile::entry(const WifSection* section, const std::string& key) const {
    const WifEntry* found = nullptr;
    if (section)
        for (const WifEntry& entry : section->entries)
            if (entry.key == key) {
                if (found)
                    fail(entry.line, fmt::format("one {} in [{}]", excerpt(key), section->name),
                         fmt::format("a second; the first is on line {}", found->line));
                found = &entry;
            }
    return found;
}

int WifFile::number(const WifEntry& entry, int low, int high, const std::string& what) const {
    const std::string_view text = without_comment(entry.value);
    const auto value = whole_number(text);
    if (!value || *value < low || *value > high)
        fail(entry.line, range_text(low, high, what), excerpt(text));
    return *value;
}

bool WifFile::boolean(const WifEntry& entry) const {
    const std::string text = lower_case(without_comment(entry.value));
    if (text == "true" || text == "on" || text == "yes" || text == "1")
        return true;
    if (text == "false" || text == "off" || text == "no" || text == "0")
        return false;
    fail(entry.line, "true, on, yes, 1, false, off, no or 0", excerpt(text));
}

std::vector<int> WifFile::list(const WifEntry& entry, int low, int high,
                               const std::string& what) const {
    std::vector<int> values;
    std::string_view rest = without_comment(entry.value);
    while (!rest.empty()) {
        const size_t comma = std::min(rest.find(','), rest.size());
        const std::string_view item = trimmed(rest.substr(0, comma));
        rest.remove_prefix(std::min(comma + 1, rest.size()));
        if (item.empty())
            continue;
        const auto value = whole_number(item);
        if (!value || *value < low || *value > high)
            fail(entry.line, range_text(low, high, what), excerpt(item));
        values.push_back(*value);
    }
    return values;
}

std::vector<WifList> WifFile::lists(const WifSection& section, int low, int high,
                                    const std::string& what) const {
    std::vector<WifList> result;
    std::unordered_map<int, int> line_of;
    for (const WifEntry& entry : section.entries) {
        const auto number = whole_number(entry.key);
        if (!number || *number < 1)
            fail(entry.line, fmt::format("an entry of [{}] numbered 1 or more", section.name),
                 excerpt(entry.key));
        const auto [first, added] = line_of.try_emplace(*number, entry.line);
        if (!added)
            fail(entry.line, fmt::format("one entry {} in [{}]", *number, section.name),
                 fmt::format("a second; the first is on line {}", first->second));
        result.push_back({*number, list(entry, low, high, what), entry.line});
    }
    return result;
}

void WifFile::fail(int line, const std::string& expected, const std::string& found) const {
    throw FileError(path_, line, expected, found);
}

} // namespace rapport
