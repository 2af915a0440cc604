#pragma once

#include <algorithm>
#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

namespace rapport {

/// Pixels to draw on, (0, 0) at the top left; what lies outside is left out.
class Canvas {
  public:
    using Colour = glm::vec3; ///< sRGB-encoded, 0 … 1

    Canvas(int width, int height, const Colour& background)
        : width_(width), bytes_(static_cast<size_t>(3) * width * height) {
        fill({0, 0}, {width, height}, background);
    }

    int width() const { return width_; }
    int height() const { return static_cast<int>(bytes_.size() / 3 / width_); }

    void set(int x, int y, const Colour& colour) {
        if (x < 0 || y < 0 || x >= width_ || y >= height())
            return;
        for (int c = 0; c < 3; ++c)
            bytes_[3 * (static_cast<size_t>(y) * width_ + x) + c] =
                static_cast<uint8_t>(255 * glm::clamp(colour[c], 0.0f, 1.0f) + 0.5f);
    }
    Colour at(int x, int y) const {
        const uint8_t* p = &bytes_[3 * (static_cast<size_t>(y) * width_ + x)];
        return glm::vec3(p[0], p[1], p[2]) / 255.0f;
    }
    /// Covers a share of the pixel.
    void blend(int x, int y, const Colour& colour, float share) {
        if (share > 0 && x >= 0 && y >= 0 && x < width_ && y < height())
            set(x, y, glm::mix(at(x, y), colour, std::min(share, 1.0f)));
    }
    /// Pixels [low, high).
    void fill(const glm::ivec2& low, const glm::ivec2& high, const Colour& colour) {
        for (int y = low.y; y < high.y; ++y)
            for (int x = low.x; x < high.x; ++x)
                set(x, y, colour);
    }
    /// RGB, row 0 at the top.
    const std::vector<uint8_t>& bytes() const { return bytes_; }

  private:
    int width_;
    std::vector<uint8_t> bytes_;
};

} // namespace rapport
