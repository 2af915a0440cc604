#include "vgsp/toml_reader.h"

#include "renderer/core/error.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <fmt/format.h>
#include <fmt/ranges.h>

namespace rapport {
namespace {

std::string place_text(const toml::source_region& region) {
    return region.begin ? fmt::format("{}:{}", region.begin.line, region.begin.column)
                        : std::string();
}

/// At most 100 bytes and a mark that there was more.
std::string excerpt(std::string_view text) {
    size_t length = 100;
    if (text.size() <= length)
        return std::string(text);
    while ((static_cast<unsigned char>(text[length]) & 0xC0) == 0x80)
        --length; // not in the middle of a UTF-8 character
    return std::string(text.substr(0, length)) + "…";
}

/// Quoted keys and texts may hold line ends, a message may not.
std::string on_one_line(std::string text) {
    for (char& c : text)
        if (static_cast<unsigned char>(c) < 0x20 || c == 0x7f)
            c = ' ';
    return text;
}

/// A value for a message.
std::string description(const toml::node& node) {
    if (const auto* text = node.as_string())
        return fmt::format("\"{}\"", excerpt(text->get()));
    if (const auto* integer = node.as_integer())
        return fmt::format("{}", integer->get());
    if (const auto* real = node.as_floating_point())
        return fmt::format("{}", real->get());
    if (const auto* array = node.as_array())
        return fmt::format("an array of {} values", array->size());
    if (const auto* boolean = node.as_boolean())
        return boolean->get() ? "true" : "false";
    return node.is_table() ? "a table" : "a date or time";
}

} // namespace

bool Domain::contains(double x) const {
    return std::isfinite(x) && (low_open ? x > low : x >= low) &&
           (high_open ? x < high : x <= high);
}

std::string Domain::text() const {
    if (high == std::numeric_limits<double>::infinity())
        return fmt::format("a number {} {}", low_open ? "above" : "not below", low);
    return fmt::format("a number in {}{}, {}{}", low_open ? '(' : '[', low, high,
                       high_open ? ')' : ']');
}

toml::table parse_toml(std::string_view text, const std::string& path) {
    try {
        return toml::parse(text);
    } catch (const toml::parse_error& error) {
        throw FileError(path, place_text(error.source()), "TOML",
                        on_one_line(excerpt(error.description())));
    }
}

TomlReader::TomlReader(const toml::table& table, std::string path, std::string name)
    : table_(table), path_(std::move(path)), name_(std::move(name)) {}

void TomlReader::allow_only(const std::vector<std::string_view>& keys) const {
    for (const auto& [key, value] : table_)
        if (std::find(keys.begin(), keys.end(), key.str()) == keys.end())
            fail_at(key.source(),
                    fmt::format("a key of {}: {}", name_.empty() ? "a cloth" : "[" + name_ + "]",
                                fmt::join(keys, ", ")),
                    fmt::format("'{}'", excerpt(key.str())));
}

std::vector<std::string> TomlReader::keys() const {
    std::vector<std::string> keys;
    for (const auto& [key, value] : table_)
        keys.emplace_back(key.str());
    return keys;
}

TomlReader TomlReader::table(std::string_view key) const {
    const toml::node& node = require(key, "a table");
    if (!node.is_table())
        fail(key, "a table", description(node));
    return TomlReader(*node.as_table(), path_, full_name(key));
}

std::string TomlReader::text(std::string_view key) const {
    const toml::node& node = require(key, "a text");
    if (!node.is_string())
        fail(key, fmt::format("a text for '{}'", key), description(node));
    return node.as_string()->get();
}

std::string TomlReader::one_of(std::string_view key,
                               std::initializer_list<std::string_view> values) const {
    const std::string expected = fmt::format("\"{}\"", fmt::join(values, "\" or \""));
    const toml::node& node = require(key, expected);
    const auto value = node.value_exact<std::string>();
    if (!value || std::find(values.begin(), values.end(), *value) == values.end())
        fail(key, fmt::format("{} for '{}'", expected, key), description(node));
    return *value;
}

double TomlReader::number_of(const toml::node& node, const std::string& what,
                             const Domain& domain) const {
    const auto value = node.is_number() ? node.value<double>() : std::nullopt;
    if (!value || !domain.contains(*value))
        fail_at(node.source(), fmt::format("{} for {}", domain.text(), what), description(node));
    return *value;
}

double TomlReader::number(std::string_view key, const Domain& domain) const {
    return number_of(require(key, domain.text()), fmt::format("'{}'", key), domain);
}

double TomlReader::number(std::string_view key, const Domain& domain, double fallback) const {
    return has(key) ? number(key, domain) : fallback;
}

int TomlReader::whole_number(std::string_view key, int low, int high) const {
    const std::string expected = fmt::format("a whole number of {} … {}", low, high);
    const toml::node& node = require(key, expected);
    const auto* const integer = node.as_integer();
    if (!integer || integer->get() < low || integer->get() > high)
        fail(key, fmt::format("{} for '{}'", expected, key), description(node));
    return int(integer->get());
}

std::vector<double> TomlReader::numbers(std::string_view key, const Domain& domain,
                                        size_t count) const {
    return numbers_of(key, domain, count, count, fmt::format("an array of {} numbers", count));
}

std::vector<double> TomlReader::numbers_or_one(std::string_view key, const Domain& domain,
                                               size_t count) const {
    if (has(key) && table_.get(key)->is_array())
        return numbers(key, domain, count);
    return {number(key, domain)};
}

std::vector<double> TomlReader::numbers_from(std::string_view key, const Domain& domain,
                                             size_t least) const {
    return numbers_of(key, domain, least, SIZE_MAX,
                      fmt::format("an array of {} or more numbers", least));
}

std::vector<double> TomlReader::numbers_of(std::string_view key, const Domain& domain, size_t least,
                                           size_t most, const std::string& expected) const {
    const toml::array* const array = require(key, expected).as_array();
    if (!array || array->size() < least || array->size() > most)
        fail(key, fmt::format("{} for '{}'", expected, key), description(*table_.get(key)));
    std::vector<double> values;
    for (const toml::node& element : *array)
        values.push_back(number_of(element, fmt::format("'{}' [{}]", key, values.size()), domain));
    return values;
}

std::vector<std::string> TomlReader::texts(std::string_view key) const {
    const toml::node& node = require(key, "an array of texts");
    if (!node.is_array())
        fail(key, fmt::format("an array of texts for '{}'", key), description(node));
    std::vector<std::string> values;
    for (const toml::node& element : *node.as_array()) {
        if (!element.is_string())
            fail_at(element.source(), fmt::format("a text in '{}'", key), description(element));
        values.push_back(element.as_string()->get());
    }
    return values;
}

void TomlReader::fail(std::string_view key, const std::string& expected,
                      const std::string& found) const {
    const toml::node* const node = table_.get(key);
    fail_at(node ? node->source() : table_.source(), expected, found);
}

const toml::node& TomlReader::require(std::string_view key, const std::string& expected) const {
    const toml::node* const node = table_.get(key);
    if (!node)
        fail(key, fmt::format("'{}', {}", full_name(key), expected), "no such key");
    return *node;
}

std::string TomlReader::full_name(std::string_view key) const {
    return name_.empty() ? std::string(key) : fmt::format("{}.{}", name_, key);
}

void TomlReader::fail_at(const toml::source_region& place, const std::string& expected,
                         const std::string& found) const {
    throw FileError(path_, place_text(place), expected, on_one_line(found));
}

} // namespace rapport
