#pragma once

#include <cmath>

namespace rapport {

/// The sRGB transfer curve (IEC 61966-2-1) of a linear value in [0, 1].
inline float encode_srgb(float linear) {
    return linear <= 0.0031308f ? 12.92f * linear : 1.055f * std::pow(linear, 1 / 2.4f) - 0.055f;
}

/// Its inverse: the linear value of an encoded one in [0, 1].
inline float decode_srgb(float encoded) {
    return encoded <= 0.04045f ? encoded / 12.92f : std::pow((encoded + 0.055f) / 1.055f, 2.4f);
}

} // namespace rapport
