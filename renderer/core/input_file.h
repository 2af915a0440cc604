#pragma once

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <string>

namespace rapport {

/// A file opened for reading in binary, and its length in bytes.
struct InputFile {
    std::ifstream stream;
    uint64_t size = 0;
};

/// A file that is missing, unreadable, or no plain file (a folder, a device) is a FileError.
InputFile open_input(const std::filesystem::path& path);

/// ".bsdf", in lower case.
std::string lower_extension(const std::filesystem::path& path);

} // namespace rapport
