#include "materials/bsdf.h"
#include "renderer/core/warp.h"

#include <cmath>
#include <fmt/format.h>

namespace rapport {
namespace {

/// Lambert's law: light leaves the side it came from, equally bright in all directions. Both sides
/// reflect, as in pbrt.
///     "rgb reflectance"  share of the light that is reflected, each in [0, 1]; default 0.5
class Diffuse final : public Bsdf {
  public:
    explicit Diffuse(const Rgb& reflectance) : reflectance_(reflectance) {}

    Rgb eval(const glm::vec3& eye, const glm::vec3& light) const override {
        return reflectance_ * cosine_density(eye, light);
    }

    float pdf(const glm::vec3& eye, const glm::vec3& light) const override {
        return scatters() ? cosine_density(eye, light) : 0;
    }

    std::optional<BsdfSample> sample(const glm::vec3& eye, float /*choice*/,
                                     const glm::vec2& u) const override {
        if (eye.z == 0 || !scatters())
            return std::nullopt;
        glm::vec3 light = square_to_cosine_hemisphere(u);
        light.z = std::copysign(light.z, eye.z);
        return BsdfSample{light, reflectance_, cosine_density(eye, light)};
    }

    Rgb albedo(const glm::vec3&) const override { return reflectance_; }

  private:
    static float cosine_density(const glm::vec3& eye, const glm::vec3& light) {
        return cosine_hemisphere_pdf(light.z * glm::sign(eye.z));
    }
    bool scatters() const { return reflectance_ != Rgb(0); }

    Rgb reflectance_;
};

std::shared_ptr<const Bsdf> make_diffuse(const MaterialContext& context) {
    const Rgb reflectance = context.params.get_rgb("reflectance", Rgb(0.5f));
    for (int i = 0; i < 3; ++i)
        if (!(reflectance[i] >= 0 && reflectance[i] <= 1))
            context.params.fail("reflectance", "numbers in [0, 1]",
                                fmt::format("{}", reflectance[i]));
    return std::make_shared<Diffuse>(reflectance);
}

const Registered<MaterialFactory> registered("diffuse", make_diffuse);

} // namespace
} // namespace rapport
