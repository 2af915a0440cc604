#include "renderer/core/warp.h"
#include "renderer/scene/image_light.h"
#include "renderer/scene/light.h"

#include <limits>

namespace rapport {
namespace {

/// Equal radiance from everywhere.
class ConstantLight final : public Light {
  public:
    explicit ConstantLight(const Rgb& radiance) : radiance_(radiance) {}

    void prepare(const glm::vec3&, float scene_radius) override { scene_radius_ = scene_radius; }

    std::optional<LightSample> sample(const glm::vec3&, const glm::vec2& u) const override {
        return LightSample{square_to_uniform_sphere(u), std::numeric_limits<float>::infinity(),
                           radiance_, uniform_sphere_pdf<float>(), false};
    }
    Rgb escaped(const glm::vec3&) const override { return radiance_; }
    float escaped_pdf(const glm::vec3&) const override { return uniform_sphere_pdf<float>(); }

    float power() const override {
        return 4 * square(static_cast<float>(kPi) * scene_radius_) * luminance(radiance_);
    }

  private:
    Rgb radiance_;
    float scene_radius_ = 1;
};

/// Light from all around, infinitely far: of one radiance, or an image's.
///     "rgb L"            radiance; default 1; or
///     "string filename"  an EXR of radiance (image_light.h)
///     "float scale"      multiplies either; default 1
std::shared_ptr<Light> make_infinite(const LightContext& context) {
    const Params& params = context.params;
    if (!params.has("filename"))
        return std::make_shared<ConstantLight>(light_radiance(params));
    if (params.has("L"))
        params.fail("L", "either L or filename", "both");
    return std::make_shared<ImageLight>(context);
}

const Registered<LightFactory> registered("infinite", make_infinite);

} // namespace
} // namespace rapport
