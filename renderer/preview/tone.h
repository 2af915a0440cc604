#pragma once

#include "renderer/core/image.h"
#include "renderer/scene/camera.h"

#include <cstdint>
#include <string>
#include <vector>

namespace rapport {

/// Which part of a picture is looked at.
enum class Layer { beauty, albedo, normals, warp, variance };
inline constexpr const char* kLayerNames[] = {"picture", "albedo", "normals", "warp streaks",
                                              "noise"};

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

/// R, G, B and 255 for each pixel of a picture (Film::image) that `camera` took: the beauty and the
/// albedo under the tone curve; normals by colour, −1 to 1 from black to white (black where there
/// is nothing); streaks along the warp (integrator/streaks.h); the noise as standard error of the
/// pixel's mean over the pixel's radiance, white at 1 (black while nothing is known of it).
std::vector<uint8_t> displayed(const Image& image, const Camera& camera, const Tone& tone);

} // namespace rapport
