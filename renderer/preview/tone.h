#pragma once

#include "renderer/core/image.h"

#include <cstdint>
#include <string>
#include <vector>

namespace rapport {

/// Which part of a picture is looked at.
enum class Layer { beauty, albedo, normals, warp, variance };
inline constexpr const char* kLayerNames[] = {"picture", "albedo", "normals", "warp", "noise"};

enum class ToneCurve {
    srgb, ///< clipped at white, as PNGs of `rapport render` are
    film, ///< rolls highlights off: the fit of the ACES reference curve by K. Narkowicz, "ACES
          ///< Filmic Tone Mapping Curve", 2015
};
inline constexpr const char* kToneCurveNames[] = {"sRGB", "film (ACES-like)"};

struct Tone {
    Layer layer = Layer::beauty;
    ToneCurve curve = ToneCurve::srgb;
    float exposure = 0; ///< stops, of the beauty and albedo

    bool operator==(const Tone&) const = default;
};

/// R, G, B and 255 for each pixel of a picture (Film::image): the beauty and the albedo under the
/// tone curve; normals and warp directions by colour, −1 to 1 from black to white (black where
/// there is nothing); the noise as standard error of the pixel's mean over the pixel's radiance,
/// white at 1 (black while nothing is known of it).
std::vector<uint8_t> displayed(const Image& image, const Tone& tone);

} // namespace rapport
