#pragma once

#include <filesystem>
#include <vector>

namespace rapport {

/// All bytes of a file; FileError when it cannot be read.
std::vector<char> read_file(const std::filesystem::path& path);

} // namespace rapport
