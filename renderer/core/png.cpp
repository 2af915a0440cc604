#include "renderer/core/png.h"
#include "renderer/core/atomic_file.h"
#include "renderer/core/image.h"
#include "renderer/core/srgb.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <new>
#include <stb/stb_image_write.h>
#include <stdexcept>

namespace rapport {

std::string png_file(std::span<const uint8_t> bytes, int width, int height, int channels) {
    if (bytes.size() != static_cast<size_t>(width) * height * channels)
        throw std::invalid_argument("a PNG needs all of its pixels");
    std::string file;
    const auto append = [](void* to, void* data, int size) {
        static_cast<std::string*>(to)->append(static_cast<const char*>(data), size);
    };
    if (!stbi_write_png_to_func(append, &file, width, height, channels, bytes.data(),
                                channels * width))
        throw std::bad_alloc(); // the only way in which stb fails here
    return file;
}

void write_png_bytes(std::span<const uint8_t> bytes, int width, int height, int channels,
                     const std::filesystem::path& path) {
    const std::string file = png_file(bytes, width, height, channels);
    write_stream_atomically(path, [&](std::ofstream& stream) { stream << file; });
}

void write_png(const Image& image, const std::filesystem::path& path) {
    const std::array planes{image.find("R"), image.find("G"), image.find("B")};
    if (!planes[0] || !planes[1] || !planes[2])
        throw std::invalid_argument("a PNG needs the channels R, G and B");

    const size_t pixels = planes[0]->size();
    std::vector<uint8_t> bytes(3 * pixels);
    for (size_t i = 0; i < pixels; ++i)
        for (size_t c = 0; c < 3; ++c) {
            const float value = (*planes[c])[i];
            const float clipped = value > 0 ? std::min(value, 1.0f) : 0.0f; // NaN is black
            bytes[3 * i + c] = static_cast<uint8_t>(255 * encode_srgb(clipped) + 0.5f);
        }
    write_png_bytes(bytes, image.width, image.height, 3, path);
}

} // namespace rapport
