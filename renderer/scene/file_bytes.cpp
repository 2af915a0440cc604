#include "renderer/scene/file_bytes.h"

#include "renderer/core/error.h"
#include "renderer/core/input_file.h"

#include <fmt/format.h>

namespace rapport {

std::vector<char> read_file(const std::filesystem::path& path) {
    InputFile file = open_input(path);
    std::vector<char> bytes(file.size);
    file.stream.read(bytes.data(), static_cast<std::streamsize>(file.size));
    const auto count = static_cast<uint64_t>(file.stream.gcount());
    if (count != file.size)
        throw FileError(path.string(), "", fmt::format("{} bytes", file.size),
                        fmt::format("{}", count));
    return bytes;
}

} // namespace rapport
