#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>

namespace rapport {

/// A PNG file in memory of pixels of `channels` (3 = RGB, 4 = RGBA) bytes each, row 0 at the top,
/// as they are.
std::string png_file(std::span<const uint8_t> bytes, int width, int height, int channels);

/// The same written out.
void write_png_bytes(std::span<const uint8_t> bytes, int width, int height, int channels,
                     const std::filesystem::path& path);

} // namespace rapport
