#include "renderer/core/error.h"

#include <fmt/format.h>

namespace rapport {
namespace {

/// What is quoted from a file may hold line ends, and worse for a terminal.
std::string one_line(std::string text) {
    for (char& c : text)
        if (static_cast<unsigned char>(c) < ' ' || c == '\x7f')
            c = ' ';
    return text;
}

} // namespace

FileError::FileError(std::string path, std::string place, std::string expected, std::string found)
    : std::runtime_error(one_line(fmt::format("{}{}{}: expected {}, found {}", path,
                                              place.empty() ? "" : ":", place, expected, found))),
      path(std::move(path)), place(std::move(place)), expected(std::move(expected)),
      found(std::move(found)) {}

FileError::FileError(std::string path, int line, std::string expected, std::string found)
    : FileError(std::move(path), line > 0 ? std::to_string(line) : std::string(),
                std::move(expected), std::move(found)) {}

} // namespace rapport
