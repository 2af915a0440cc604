#include "renderer/core/error.h"
#include "renderer/scene/light/light.h"

#include <algorithm>
#include <fmt/format.h>

namespace rapport {
namespace {

/// Light from a point into a cone, with a soft edge.
///     "rgb I"                intensity on the axis, power per steradian; default 1
///     "point3 from"  and
///     "point3 to"            a point in the middle of the light; default (0 0 0) and (0 0 1)
///     "float coneangle"      between the axis and where it is dark [degrees]; default 30
///     "float conedeltaangle" width of the edge [degrees]; default 5
///     "float scale"          multiplies I; default 1
class SpotLight final : public Light {
  public:
    SpotLight(const glm::vec3& place, const glm::vec3& axis, const Rgb& intensity,
              float cosine_dark, float cosine_full)
        : place_(place), axis_(axis), intensity_(intensity), cosine_dark_(cosine_dark),
          cosine_full_(cosine_full) {}

    std::optional<LightSample> sample(const glm::vec3& from, const glm::vec2&) const override {
        const glm::vec3 way = place_ - from;
        const float distance = glm::length(way);
        if (!(distance > 0))
            return std::nullopt;
        const glm::vec3 direction = way / distance;
        const float share = falloff(-glm::dot(direction, axis_));
        if (!(share > 0))
            return std::nullopt;
        return LightSample{direction, distance, share * intensity_ / distance / distance, 0, true};
    }

    float power() const override {
        // The edge, an antisymmetric step in cosθ, counts half.
        const float solid_angle =
            static_cast<float>(2 * kPi) * (1 - 0.5f * (cosine_full_ + cosine_dark_));
        return solid_angle * luminance(intensity_);
    }
    bool is_delta() const override { return true; }
    bool has_place() const override { return true; }

  private:
    /// pbrt's: a smooth step (3t² − 2t³) in cosθ.
    float falloff(float cosine) const {
        if (cosine_full_ <= cosine_dark_)
            return cosine > cosine_dark_ ? 1 : 0;
        const float t =
            std::clamp((cosine - cosine_dark_) / (cosine_full_ - cosine_dark_), 0.0f, 1.0f);
        return t * t * (3 - 2 * t);
    }

    glm::vec3 place_, axis_;
    Rgb intensity_;
    float cosine_dark_, cosine_full_;
};

std::shared_ptr<Light> make_spot(const LightContext& context) {
    const Params& params = context.params;
    const glm::vec3 from = params.get_point("from", glm::vec3(0));
    const glm::vec3 to = params.get_point("to", glm::vec3(0, 0, 1));
    const glm::vec3 axis = glm::mat3(context.to_world) * (to - from);
    if (!(glm::length(axis) > 0))
        params.fail("from", "two points apart for from and to", "the same point twice");
    const float angle = params.get_float("coneangle", 30);
    const float edge = params.get_float("conedeltaangle", 5);
    if (!(angle > 0 && angle <= 180))
        params.fail("coneangle", "an angle above 0, to 180 degrees", fmt::format("{}", angle));
    if (!(edge >= 0 && edge <= angle))
        params.fail("conedeltaangle", "an angle from 0 to coneangle", fmt::format("{}", edge));
    return std::make_shared<SpotLight>(glm::vec3(context.to_world * glm::vec4(from, 1)),
                                       glm::normalize(axis), light_color(params, "I"),
                                       std::cos(radians(angle)), std::cos(radians(angle - edge)));
}

const Registered<LightFactory> registered("spot", make_spot);

} // namespace
} // namespace rapport
