#pragma once

#include "renderer/core/bands.h"

#include <filesystem>
#include <glm/glm.hpp>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace rapport {

/// A picture of 8 bits per channel, as PNG, JPEG, TGA and BMP hold it.
class Picture {
  public:
    /// FileError, naming `name`, for what is no such picture.
    Picture(std::span<const unsigned char> file, const std::string& name);

    glm::ivec2 size() const { return size_; }
    /// Linear, after undoing the sRGB curve or (`linear`) as it stands; row 0 is the top.
    Rgb pixel(int x, int y, bool linear) const;
    float alpha(int x, int y) const; ///< 1 where the file tells none

  private:
    glm::ivec2 size_{0};
    std::vector<glm::u8vec4> pixels_;
};

/// How a picture is laid over the UV plane, on which it fills the unit square upright.
struct PictureMapping {
    enum class Wrap { repeat, mirror, clamp, black };
    Wrap wrap_u = Wrap::repeat, wrap_v = Wrap::repeat; ///< beyond the unit square
    glm::vec2 scale{1}, offset{0};                     ///< of the UVs, before the lookup
    bool linear = false;                               ///< values are not sRGB-encoded
};

/// What a picture says of a surface: bilinear lookup.
class PictureTexture {
  public:
    PictureTexture(std::shared_ptr<const Picture> picture, const PictureMapping& mapping,
                   const Rgb& factor);
    Rgb operator()(const glm::vec2& uv) const; ///< reflectance: the factor times the picture
    float alpha(const glm::vec2& uv) const;

  private:
    template <class OfPixel> auto bilinear(const glm::vec2& uv, const OfPixel& of_pixel) const;

    std::shared_ptr<const Picture> picture_;
    PictureMapping mapping_;
    Rgb factor_;
};

/// A picture as it stands in its file, not yet decoded.
struct EncodedPicture {
    std::string name; ///< for messages
    std::vector<unsigned char> bytes;
};

/// How much of a surface is there: a factor times the alpha of its picture and of its vertices;
/// with a cutoff, all where that reaches it, and nothing elsewhere.
struct Opacity {
    float factor;
    std::optional<float> cutoff = std::nullopt;
};

/// Colour that a model's file gives to a part, for those that wear nothing else; times that of the
/// vertices, where they have one.
struct BaseColor {
    Rgb factor{0.5f};                              ///< pbrt's grey, where the file gives none
    std::shared_ptr<const EncodedPicture> picture; ///< or none
    PictureMapping mapping;
    std::optional<Opacity> opacity; ///< or all of it is there
};

} // namespace rapport
