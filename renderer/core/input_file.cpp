#include "renderer/core/input_file.h"

#include "renderer/core/error.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <cerrno>
#include <cstring>
#include <fmt/format.h>
#include <system_error>

namespace rapport {
namespace {

thread_local InputLog* innermost_log = nullptr;

/// Of all bytes, word by word (FNV-1a with the upper half folded in); the stream is left at its
/// start.
std::string hash_of(std::ifstream& stream) {
    uint64_t hash = 0xcbf29ce484222325;
    std::array<uint64_t, 8192> words;
    do {
        stream.read(reinterpret_cast<char*>(words.data()), sizeof words);
        const auto count = static_cast<size_t>(stream.gcount());
        const size_t rounded = (count + 7) / 8;
        std::memset(reinterpret_cast<char*>(words.data()) + count, 0, rounded * 8 - count);
        hash ^= count;
        for (size_t i = 0; i < rounded; ++i) {
            hash = (hash ^ words[i]) * 0x100000001b3;
            hash ^= hash >> 32;
        }
    } while (stream);
    stream.clear();
    stream.seekg(0);
    return fmt::format("{:016x}", hash);
}

} // namespace

InputLog::InputLog(Of of) : of_(of), outer_(innermost_log) { innermost_log = this; }
InputLog::~InputLog() { innermost_log = outer_; }

InputFile open_input(const std::filesystem::path& path) {
    std::error_code error;
    const std::filesystem::path canonical = std::filesystem::weakly_canonical(path, error);
    for (InputLog* log = innermost_log; log; log = log->outer_)
        log->files_.insert(error ? path : canonical);
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
    for (InputLog* log = innermost_log; log; log = log->outer_)
        if (log->of_ == InputLog::Of::bytes)
            log->hashes_[path.filename().string()] += hash_of(file.stream) + ' ';
    return file;
}

std::string lower_extension(const std::filesystem::path& path) {
    std::string extension = path.extension().string();
    std::ranges::transform(extension, extension.begin(),
                           [](unsigned char c) { return std::tolower(c); });
    return extension;
}

} // namespace rapport
