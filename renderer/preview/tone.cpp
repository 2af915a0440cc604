#include "renderer/preview/tone.h"

#include "renderer/core/parallel.h"
#include "renderer/core/srgb.h"
#include "renderer/integrator/streaks.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/glm.hpp>

namespace rapport {
namespace {

/// The sRGB curve in 8 bits by a table: of 4096 steps in the square root, which are fine enough for
/// each of the 256 values to come out where it should, or next to it.
class SrgbTable {
  public:
    SrgbTable() {
        for (size_t i = 0; i < steps_.size(); ++i) {
            const float root = static_cast<float>(i) / (steps_.size() - 1);
            steps_[i] = static_cast<uint8_t>(255 * encode_srgb(root * root) + 0.5f);
        }
    }
    uint8_t operator()(float linear) const {
        const float clipped = linear > 0 ? std::min(linear, 1.0f) : 0.0f; // NaN is black
        return steps_[static_cast<size_t>(std::sqrt(clipped) * (steps_.size() - 1) + 0.5f)];
    }

  private:
    std::array<uint8_t, 4096> steps_;
};

float film_curve(float x) {
    x *= 0.6f; // Narkowicz's fit with its exposure brought back to that of the other curve
    return x * (2.51f * x + 0.03f) / (x * (2.43f * x + 0.59f) + 0.14f);
}

uint8_t linear_byte(float value) {
    return static_cast<uint8_t>(255 * std::clamp(value, 0.0f, 1.0f) + 0.5f);
}

using Planes = std::array<const std::vector<float>*, 3>;

Planes planes(const Image& image, const std::string& prefix, const char* names) {
    Planes found;
    for (int c = 0; c < 3; ++c)
        found[c] = image.find(prefix + names[c]);
    return found;
}

glm::vec3 at(const Planes& planes, size_t pixel) {
    return {(*planes[0])[pixel], (*planes[1])[pixel], (*planes[2])[pixel]};
}

} // namespace

std::vector<uint8_t> displayed(const Image& image, const Camera& camera, const Tone& tone) {
    static const SrgbTable srgb;
    std::vector<uint8_t> bytes(4 * static_cast<size_t>(image.width) * image.height, 255);
    const Planes radiance = planes(image, "", "RGB");
    const float gain = std::exp2(tone.exposure);
    const auto toned = [&](const Planes& light, size_t i, int c) {
        const float value = gain * (*light[c])[i];
        return srgb(tone.curve == ToneCurve::film ? film_curve(std::max(value, 0.0f)) : value);
    };
    Image streaks;
    Planes shown = radiance;
    if (tone.layer == Layer::albedo)
        shown = planes(image, "albedo.", "RGB");
    else if (tone.layer == Layer::normals)
        shown = planes(image, "N.", "XYZ");
    else if (tone.layer == Layer::warp) {
        streaks = warp_streaks(image, camera);
        shown = planes(streaks, "", "RGB");
    } else if (tone.layer == Layer::variance)
        shown = planes(image, "variance.", "RGB");
    const auto value = [&](size_t i, int c) -> uint8_t {
        switch (tone.layer) {
        case Layer::beauty:
        case Layer::albedo:
            return toned(shown, i, c);
        case Layer::warp:
            return srgb((*shown[c])[i]);
        case Layer::normals: {
            const glm::vec3 direction = at(shown, i);
            return direction == glm::vec3(0) ? 0 : linear_byte(0.5f + 0.5f * direction[c]);
        }
        case Layer::variance:
            if (!shown[c] || !((*radiance[c])[i] > 0))
                return 0;
            return linear_byte(std::sqrt((*shown[c])[i]) / (*radiance[c])[i]);
        }
        return 0;
    };
    parallel_for(static_cast<size_t>(image.height), [&](size_t y) {
        for (size_t i = y * image.width; i < (y + 1) * image.width; ++i)
            for (int c = 0; c < 3; ++c)
                bytes[4 * i + c] = value(i, c);
    });
    return bytes;
}

} // namespace rapport
