#pragma once

#include "renderer/core/error.h"

#include <filesystem>
#include <string>

namespace rapport {

struct PbrtToken {
    enum class Kind { end, identifier, string, number, open, close } kind = Kind::end;
    std::string text; ///< identifier, or string without its quotes and escapes; numbers as written
    double number = 0;
    int line = 1, column = 1; ///< of its first byte, counted from 1
};

/// Cuts a pbrt-v4 scene file into tokens.
class PbrtLexer {
  public:
    explicit PbrtLexer(const std::filesystem::path& file);

    const PbrtToken& peek() const { return token_; }
    PbrtToken next();

    /// For throwing: `token` stands where `expected` should.
    FileError error(const PbrtToken& token, const std::string& expected) const;
    FileError error(const PbrtToken& token, const std::string& expected,
                    const std::string& found) const;
    const std::string& path() const { return path_; }

  private:
    PbrtToken scan();
    void skip_blanks();
    void scan_string(PbrtToken& token);
    void scan_number(PbrtToken& token);
    char take();
    bool at_end() const { return position_ == text_.size(); }

    std::string path_, text_;
    size_t position_ = 0;
    int line_ = 1, column_ = 1;
    PbrtToken token_;
};

} // namespace rapport
