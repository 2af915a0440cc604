#include "renderer/scene/picture.h"

#include "renderer/core/error.h"
#include "renderer/core/srgb.h"

#include <array>
#include <cmath>
#include <limits>
#include <stb/stb_image.h>

namespace rapport {
namespace {

std::array<float, 256> decoding(bool linear) {
    std::array<float, 256> table;
    for (int i = 0; i < 256; ++i) {
        const float value = static_cast<float>(i) / 255;
        table[static_cast<size_t>(i)] = linear ? value : decode_srgb(value);
    }
    return table;
}

/// Index in [0, size) of a pixel on the endless plane, or −1 where that is black.
int wrapped(int i, int size, PictureMapping::Wrap wrap) {
    using Wrap = PictureMapping::Wrap;
    if (i >= 0 && i < size)
        return i;
    if (wrap == Wrap::black)
        return -1;
    if (wrap == Wrap::clamp)
        return i < 0 ? 0 : size - 1;
    const int period = wrap == Wrap::mirror ? 2 * size : size;
    const int place = (i % period + period) % period;
    return place < size ? place : 2 * size - 1 - place;
}

} // namespace

Picture::Picture(std::span<const unsigned char> file, const std::string& name) {
    int channels = 0;
    stbi_uc* decoded = nullptr;
    if (file.size() <= static_cast<size_t>(std::numeric_limits<int>::max()))
        decoded = stbi_load_from_memory(file.data(), static_cast<int>(file.size()), &size_.x,
                                        &size_.y, &channels, 4);
    if (!decoded) {
        const char* reason = stbi_failure_reason();
        throw FileError(name, "", "a picture (PNG, JPEG, TGA or BMP)",
                        reason ? reason : "something else");
    }
    const std::unique_ptr<stbi_uc, void (*)(void*)> keeper(decoded, stbi_image_free);
    pixels_.reserve(static_cast<size_t>(size_.x) * size_.y);
    for (size_t i = 0; i < static_cast<size_t>(size_.x) * size_.y; ++i)
        pixels_.emplace_back(decoded[4 * i], decoded[4 * i + 1], decoded[4 * i + 2],
                             decoded[4 * i + 3]);
}

Rgb Picture::pixel(int x, int y, bool linear) const {
    static const std::array<float, 256> kDecoded[] = {decoding(false), decoding(true)};
    const glm::u8vec4 value = pixels_[static_cast<size_t>(y) * size_.x + x];
    const auto& table = kDecoded[linear];
    return {table[value.r], table[value.g], table[value.b]};
}

float Picture::alpha(int x, int y) const {
    return static_cast<float>(pixels_[static_cast<size_t>(y) * size_.x + x].a) / 255;
}

PictureTexture::PictureTexture(std::shared_ptr<const Picture> picture,
                               const PictureMapping& mapping, const Rgb& factor)
    : picture_(std::move(picture)), mapping_(mapping), factor_(factor) {}

/// Of a function of the pixels, 0 where there are none.
template <class OfPixel>
auto PictureTexture::bilinear(const glm::vec2& uv, const OfPixel& of_pixel) const {
    constexpr double kFarthest = 1 << 30; // pixels whose numbers still fit an int
    const glm::dvec2 mapped =
        glm::dvec2(mapping_.scale) * glm::dvec2(uv) + glm::dvec2(mapping_.offset);
    const glm::dvec2 size(picture_->size());
    const glm::dvec2 place =
        glm::clamp(glm::dvec2(mapped.x, 1 - mapped.y) * size - 0.5, -kFarthest, kFarthest);
    const glm::dvec2 floor = glm::floor(place);
    const glm::vec2 f(place - floor);
    const auto at = [&](int right, int down) {
        const int x =
            wrapped(static_cast<int>(floor.x) + right, picture_->size().x, mapping_.wrap_u);
        const int y =
            wrapped(static_cast<int>(floor.y) + down, picture_->size().y, mapping_.wrap_v);
        using Value = decltype(of_pixel(x, y));
        return x < 0 || y < 0 ? Value(0) : of_pixel(x, y);
    };
    return glm::mix(glm::mix(at(0, 0), at(1, 0), f.x), glm::mix(at(0, 1), at(1, 1), f.x), f.y);
}

Rgb PictureTexture::operator()(const glm::vec2& uv) const {
    return factor_ *
           bilinear(uv, [&](int x, int y) { return picture_->pixel(x, y, mapping_.linear); });
}

float PictureTexture::alpha(const glm::vec2& uv) const {
    return bilinear(uv, [&](int x, int y) { return picture_->alpha(x, y); });
}

} // namespace rapport
