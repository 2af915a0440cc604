#pragma once

#include "tests/support/temporary_folder.h"

#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <string_view>

namespace rapport::tests {

inline std::string read_bytes(const std::filesystem::path& path) {
    std::ifstream file(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
}

inline void write_bytes(const std::filesystem::path& path, const std::string& bytes) {
    std::filesystem::remove(path); // ext4 waits for the disk when a file is truncated and rewritten
    std::ofstream(path, std::ios::binary)
        .write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
}

/// The same into a folder; the path.
inline std::filesystem::path write_bytes(const TemporaryFolder& folder, const std::string& name,
                                         std::string_view bytes) {
    const std::filesystem::path path = folder / name;
    write_bytes(path, std::string(bytes));
    return path;
}

} // namespace rapport::tests
