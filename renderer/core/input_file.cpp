#include "renderer/core/input_file.h"

#include "renderer/core/error.h"

#include <algorithm>
#include <cctype>
#include <cerrno>
#include <system_error>

namespace rapport {

InputFile open_input(const std::filesystem::path& path) {
    std::error_code error;
    const auto status = std::filesystem::status(path, error);
    if (status.type() == std::filesystem::file_type::not_found)
        throw FileError(path.string(), "", "a file", "no such file");
    if (status.type() != std::filesystem::file_type::regular)
        throw FileError(path.string(), "", "a file",
                        error                                   ? error.message()
                        : std::filesystem::is_directory(status) ? "a folder"
                                                                : "a device or the like");
    InputFile file;
    errno = 0;
    file.stream.open(path, std::ios::binary);
    if (!file.stream)
        throw FileError(path.string(), "", "a readable file",
                        std::generic_category().message(errno));
    file.size = std::filesystem::file_size(path, error);
    if (error)
        throw FileError(path.string(), "", "a readable file", error.message());
    return file;
}

std::string lower_extension(const std::filesystem::path& path) {
    std::string extension = path.extension().string();
    std::ranges::transform(extension, extension.begin(),
                           [](unsigned char c) { return std::tolower(c); });
    return extension;
}

} // namespace rapport
