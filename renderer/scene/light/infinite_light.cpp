#include "renderer/scene/light/image_light.h"
#include "renderer/scene/light/light.h"

namespace rapport {
namespace {

/// Equal radiance from everywhere. It has no samples of its own: directions drawn from the BSDF are
/// already in proportion to what such a light contributes, and to mix in others would add noise.
class ConstantLight final : public Light {
  public:
    explicit ConstantLight(const Rgb& radiance) : radiance_(radiance) {}

    std::optional<LightSample> sample(const glm::vec3&, const glm::vec2&) const override {
        return std::nullopt;
    }
    EscapedLight escaped(const glm::vec3&) const override { return {radiance_, 0}; }
    float power() const override { return 0; }

  private:
    Rgb radiance_;
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
