#pragma once

#include <initializer_list>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <toml++/toml.h>
#include <vector>

namespace rapport {

/// The numbers that a key may have; an open end does not belong to them.
struct Domain {
    double low = 0, high = 0;
    bool low_open = false, high_open = false;

    bool contains(double x) const;
    std::string text() const;
};

/// Parses `text`; what is no TOML is a FileError at its line and column in `path`.
toml::table parse_toml(std::string_view text, const std::string& path);

/// Typed reading of one table of a TOML file. Whatever is wrong is a FileError at line and column
/// of the value, or of the table where the key is missing.
class TomlReader {
  public:
    /// `name` is what the file calls the table; empty for the root.
    TomlReader(const toml::table& table, std::string path, std::string name = {});

    /// FileError for the first key that is not one of these; lists them.
    void allow_only(const std::vector<std::string_view>& keys) const;
    bool has(std::string_view key) const { return table_.contains(key); }
    /// What the file calls the key, its tables' names included.
    std::string full_name(std::string_view key) const;
    std::vector<std::string> keys() const;
    /// The table of that key, which must be there.
    TomlReader table(std::string_view key) const;

    std::string text(std::string_view key) const;
    std::string one_of(std::string_view key, std::initializer_list<std::string_view> values) const;
    double number(std::string_view key, const Domain& domain) const;
    double number(std::string_view key, const Domain& domain, double fallback) const;
    int whole_number(std::string_view key, int low, int high) const;
    /// `count` numbers.
    std::vector<double> numbers(std::string_view key, const Domain& domain, size_t count) const;
    /// The same, or one number for all.
    std::vector<double> numbers_or_one(std::string_view key, const Domain& domain,
                                       size_t count) const;
    /// Any number of numbers, at least `least`.
    std::vector<double> numbers_from(std::string_view key, const Domain& domain,
                                     size_t least) const;
    std::vector<std::string> texts(std::string_view key) const;

    /// At the value of `key`, or at the table if it has no such key.
    [[noreturn]] void fail(std::string_view key, const std::string& expected,
                           const std::string& found) const;

  private:
    const toml::node& require(std::string_view key, const std::string& expected) const;
    double number_of(const toml::node& node, const std::string& what, const Domain& domain) const;
    std::vector<double> numbers_of(std::string_view key, const Domain& domain, size_t least,
                                   size_t most, const std::string& expected) const;
    [[noreturn]] void fail_at(const toml::source_region& place, const std::string& expected,
                              const std::string& found) const;

    const toml::table& table_;
    std::string path_, name_;
};

} // namespace rapport
