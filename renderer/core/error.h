#pragma once

#include <stdexcept>
#include <string>

namespace rapport {

/// Bad input, told in one line (control characters of what is quoted are blanks there): which file,
/// where in it, what was expected and what was found. Thrown wherever a file or the command line is
/// read; only `main` prints it (exit status 2).
struct FileError : std::runtime_error {
    /// `place` is a position inside the file ("12", "12:7", "meshes[0].primitives[1]"), or empty.
    FileError(std::string path, std::string place, std::string expected, std::string found);
    FileError(std::string path, int line, std::string expected, std::string found);

    std::string path;
    std::string place;
    std::string expected;
    std::string found;
};

} // namespace rapport
