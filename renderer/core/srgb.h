#pragma once

#include <cmath>

namespace rapport {

/// The sRGB transfer curve (IEC 61966-2-1) of a linear value in [0, 1].
inline float encode_srgb(float linear) {
    return linear <= 0.0031308f ? 12.92f * linear : 1.055f * std::pow(linear, 1 / 2.4f) - 0.055f;
}

} // namespace rapport
