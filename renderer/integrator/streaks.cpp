#include "renderer/integrator/streaks.h"

#include "renderer/core/parallel.h"
#include "renderer/core/rng.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace rapport {
namespace {

constexpr int kReach = 12; ///< pixels that a streak goes to either side
constexpr float kContrast = 1.2f;

using Planes = std::array<const std::vector<float>*, 3>;

Planes planes(const Image& image, const char* layer) {
    Planes found{};
    for (size_t c = 0; c < 3; ++c)
        found[c] = image.find(std::string(layer) + "." + "XYZ"[c]);
    return found;
}

class Streaks {
  public:
    Streaks(const Image& rendered, const Camera& camera)
        : image_(rendered), camera_(camera), rays_(camera), normal_(planes(rendered, "N")),
          warp_(planes(rendered, "warp")), depth_(*rendered.find("Z")), ways_(depth_.size()),
          noise_(depth_.size()) {
        parallel_for(static_cast<size_t>(image_.height), [&](size_t row) {
            for (int x = 0; x < image_.width; ++x) {
                const glm::ivec2 pixel(x, static_cast<int>(row));
                if (depth_[index(pixel)] == 0)
                    continue;
                ways_[index(pixel)] = direction(pixel);
                noise_[index(pixel)] = noise(pixel);
            }
        });
    }

    Image draw() const {
        Image drawn(image_.width, image_.height, {"R", "G", "B"});
        parallel_for(static_cast<size_t>(image_.height), [&](size_t row) {
            for (int x = 0; x < image_.width; ++x) {
                const glm::ivec2 pixel(x, static_cast<int>(row));
                if (depth_[index(pixel)] == 0)
                    continue;
                const glm::vec3 eye = -rays_(glm::vec2(pixel) + 0.5f).dir;
                const glm::vec3 n = value(normal_, pixel);
                const float facing = glm::dot(n, eye) / std::max(glm::length(n), 1e-20f);
                const float shade = 0.25f + 0.75f * std::abs(facing);
                const float grey =
                    std::clamp(0.5f + kContrast * (smeared(pixel) - 0.5f), 0.0f, 1.0f);
                const glm::vec3 color = facing >= 0 ? glm::vec3(1) : glm::vec3(0.55f, 0.7f, 1);
                for (int c = 0; c < 3; ++c)
                    drawn.data[static_cast<size_t>(c)][index(pixel)] = shade * grey * color[c];
            }
        });
        return drawn;
    }

  private:
    size_t index(const glm::ivec2& p) const {
        return static_cast<size_t>(p.y) * image_.width + p.x;
    }
    glm::vec3 value(const Planes& planes, const glm::ivec2& p) const {
        return {(*planes[0])[index(p)], (*planes[1])[index(p)], (*planes[2])[index(p)]};
    }

    /// Unit direction of the warp on the film (y down), or 0 where it points along the view.
    glm::vec2 direction(const glm::ivec2& pixel) const {
        const glm::vec3 warp = value(warp_, pixel);
        const kernel::Ray ray = rays_(glm::vec2(pixel) + 0.5f);
        const kernel::Ray right = rays_(glm::vec2(pixel) + glm::vec2(1.5f, 0.5f));
        const kernel::Ray below = rays_(glm::vec2(pixel) + glm::vec2(0.5f, 1.5f));
        // How a pixel to the right, and one below, move a point at that distance; the warp in
        // these.
        const glm::vec3 across =
            camera_.kind == Camera::Kind::perspective ? right.dir - ray.dir : right.org - ray.org;
        const glm::vec3 down =
            camera_.kind == Camera::Kind::perspective ? below.dir - ray.dir : below.org - ray.org;
        const glm::vec2 along(glm::dot(warp, across) / glm::dot(across, across),
                              glm::dot(warp, down) / glm::dot(down, down));
        const float length = glm::length(along);
        return length > 0 && std::isfinite(length) ? along / length : glm::vec2(0);
    }

    static float noise(const glm::ivec2& p) {
        return CounterRng(0, Purpose::pixel, static_cast<uint64_t>(static_cast<uint32_t>(p.y)),
                          static_cast<uint64_t>(static_cast<uint32_t>(p.x)))
            .uniform_float();
    }

    /// Mean of the noise along the streak through a pixel.
    float smeared(const glm::ivec2& start) const {
        float sum = noise_[index(start)];
        int count = 1;
        for (const float sign : {1.0f, -1.0f}) {
            glm::vec2 place = glm::vec2(start) + 0.5f;
            glm::vec2 before = sign * ways_[index(start)];
            for (int step = 0; step < kReach; ++step) {
                glm::vec2 way = ways_[index(glm::ivec2(place))];
                if (glm::dot(way, before) < 0) // the warp has no sign on the picture
                    way = -way;
                place +=
                    way / std::max({std::abs(way.x), std::abs(way.y), 1e-6f}); // to the next pixel
                before = way;
                const glm::ivec2 pixel(glm::floor(place));
                if (way == glm::vec2(0) || pixel.x < 0 || pixel.y < 0 || pixel.x >= image_.width ||
                    pixel.y >= image_.height || depth_[index(pixel)] == 0)
                    break;
                sum += noise_[index(pixel)];
                ++count;
            }
        }
        return 0.5f +
               (sum / static_cast<float>(count) - 0.5f) * std::sqrt(static_cast<float>(count));
    }

    const Image& image_;
    const Camera& camera_;
    const CameraRays rays_;
    const Planes normal_, warp_;
    const std::vector<float>& depth_;
    std::vector<glm::vec2> ways_; ///< of each pixel that shows something: direction()
    std::vector<float> noise_;    ///< and noise()
};

} // namespace

Image warp_streaks(const Image& rendered, const Camera& camera) {
    return Streaks(rendered, camera).draw();
}

} // namespace rapport
