#pragma once

#include "renderer/scene/light/light.h"

namespace rapport {

/// Another light, which is prepared, dimmed by `scale` and, if it is infinitely far, turned by a
/// rotation.
class AdjustedLight final : public Light {
  public:
    AdjustedLight(std::shared_ptr<const Light> light, float scale, const glm::mat3& rotation)
        : light_(std::move(light)), scale_(scale), rotation_(rotation),
          inverse_(glm::transpose(rotation)) {}

    std::optional<LightSample> sample(const glm::vec3& from, const glm::vec2& u) const override {
        std::optional<LightSample> sample = light_->sample(from, u);
        if (sample) {
            sample->direction = rotation_ * sample->direction;
            sample->radiance *= scale_;
        }
        return sample;
    }
    EscapedLight escaped(const glm::vec3& direction) const override {
        const auto [radiance, pdf] = light_->escaped(inverse_ * direction);
        return {scale_ * radiance, pdf};
    }
    bool is_delta() const override { return light_->is_delta(); }
    bool has_place() const override { return light_->has_place(); }
    float power() const override { return scale_ * light_->power(); }

  private:
    std::shared_ptr<const Light> light_;
    float scale_;
    glm::mat3 rotation_, inverse_;
};

} // namespace rapport
