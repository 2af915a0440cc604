#include "renderer/core/error.h"
#include "renderer/scene/light/light.h"

#include <limits>

namespace rapport {
namespace {

/// Parallel light, like the sun's without its disc.
///     "rgb L"        irradiance on a surface that faces it; default 1
///     "point3 from"  and
///     "point3 to"    give the direction in which the light travels; default (0 0 0) to (0 0 1)
///     "float scale"  multiplies L; default 1
class DistantLight final : public Light {
  public:
    DistantLight(const glm::vec3& towards_light, const Rgb& radiance)
        : towards_light_(towards_light), radiance_(radiance) {}

    void prepare(const glm::vec3&, float scene_radius) override { scene_radius_ = scene_radius; }

    std::optional<LightSample> sample(const glm::vec3&, const glm::vec2&) const override {
        return LightSample{towards_light_, std::numeric_limits<float>::infinity(), radiance_, 0,
                           true};
    }

    float power() const override {
        return static_cast<float>(kPi) * square(scene_radius_) * luminance(radiance_);
    }
    bool is_delta() const override { return true; }

  private:
    glm::vec3 towards_light_;
    Rgb radiance_;
    float scene_radius_ = 1;
};

std::shared_ptr<Light> make_distant(const LightContext& context) {
    const Params& params = context.params;
    const glm::vec3 from = params.get_point("from", glm::vec3(0));
    const glm::vec3 to = params.get_point("to", glm::vec3(0, 0, 1));
    const glm::vec3 towards_light = glm::mat3(context.to_world) * (from - to);
    if (!(glm::length(towards_light) > 0))
        params.fail("from", "two points apart for from and to", "the same point twice");
    return std::make_shared<DistantLight>(glm::normalize(towards_light), light_radiance(params));
}

const Registered<LightFactory> registered("distant", make_distant);

} // namespace
} // namespace rapport
