#include "renderer/scene/light/light.h"

namespace rapport {
namespace {

/// Light from a point, equally in all directions.
///     "rgb I"        intensity, power per steradian; default 1
///     "point3 from"  where it is; default (0 0 0)
///     "float scale"  multiplies I; default 1
class PointLight final : public Light {
  public:
    PointLight(const glm::vec3& place, const Rgb& intensity)
        : place_(place), intensity_(intensity) {}

    std::optional<LightSample> sample(const glm::vec3& from, const glm::vec2&) const override {
        const glm::vec3 way = place_ - from;
        const float distance = glm::length(way);
        if (!(distance > 0))
            return std::nullopt;
        return LightSample{way / distance, distance, intensity_ / distance / distance, 0, true};
    }

    float power() const override { return static_cast<float>(4 * kPi) * luminance(intensity_); }
    bool is_delta() const override { return true; }
    bool has_place() const override { return true; }

  private:
    glm::vec3 place_;
    Rgb intensity_;
};

std::shared_ptr<Light> make_point(const LightContext& context) {
    const glm::vec3 from = context.params.get_point("from", glm::vec3(0));
    return std::make_shared<PointLight>(glm::vec3(context.to_world * glm::vec4(from, 1)),
                                        light_color(context.params, "I"));
}

const Registered<LightFactory> registered("point", make_point);

} // namespace
} // namespace rapport
