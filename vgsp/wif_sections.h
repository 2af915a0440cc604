#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace rapport {

/// One `key=value` line.
struct WifEntry {
    std::string key, value; ///< trimmed; the key in lower case
    int line = 0;
};

struct WifSection {
    std::string name; ///< as the format spells it, for messages
    int line = 0;
    std::vector<WifEntry> entries;
};

/// A line `number=list` of a section that is indexed by thread, treadle, pick or colour.
struct WifList {
    int number = 0; ///< from 1
    std::vector<int> values;
    int line = 0;
};

/// The sections of a Weaving Information File that say how the cloth interlaces and what colours
/// it has, as entries with their lines; the many others (private ones, texts, notes, the unreliable
/// CONTENTS) are passed over unread. Every failure is a FileError with the line.
class WifFile {
  public:
    /// Line ends of any system, a UTF-8 byte order mark, and bytes of any code page are accepted;
    /// a section read twice, or a line in one that is neither entry nor comment, is not.
    explicit WifFile(const std::filesystem::path& path);

    /// The section of that (lower-case) name, or nullptr.
    const WifSection* find(const std::string& name) const;
    /// That section; if there is none, an error at the end of the file that says what it is for.
    const WifSection& require(const std::string& name, const std::string& purpose) const;

    /// The entry of that (lower-case) key, or nullptr also if there is no section; a second one is
    /// an error.
    const WifEntry* entry(const WifSection* section, const std::string& key) const;

    /// Values in the format's syntax: what follows a ';' is a comment. `what` names the value in
    /// the message.
    int number(const WifEntry& entry, int low, int high, const std::string& what) const;
    bool boolean(const WifEntry& entry) const;
    /// Comma-separated whole numbers of `low` … `high`; items left empty are skipped.
    std::vector<int> list(const WifEntry& entry, int low, int high, const std::string& what) const;
    /// All entries of a section that is indexed from 1; a second entry of a number is an error.
    std::vector<WifList> lists(const WifSection& section, int low, int high,
                               const std::string& what) const;

    [[noreturn]] void fail(int line, const std::string& expected, const std::string& found) const;

  private:
    void read_line(const std::string& line, int number, WifSection*& section);

    std::string path_;
    int last_line_ = 1;
    std::map<std::string, WifSection> sections_;
};

} // namespace rapport
