#pragma once

#include <cstdint>
#include <filesystem>
#include <span>

namespace rapport {

/// Pixels of `channels` (3 = RGB, 4 = RGBA) bytes each, row 0 at the top, as they are.
void write_png_bytes(std::span<const uint8_t> bytes, int width, int height, int channels,
                     const std::filesystem::path& path);

} // namespace rapport
