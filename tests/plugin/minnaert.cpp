#include "materials/bsdf.h"
#include "renderer/core/warp.h"

#include <cmath>

namespace {

using namespace rapport;

/// Minnaert's law (1941), of the moon and of some velvets: f = ρ·(cosθi·cosθo)^(k − 1)/π on either
/// side; k = 1 is Lambert's.
///     "rgb reflectance"  ρ; default 0.5
///     "float darkening"  k, at least 1; default 1
class Minnaert final : public Bsdf {
  public:
    Minnaert(const Rgb& reflectance, float k) : reflectance_(reflectance), k_(k) {}

    Rgb eval(const glm::vec3& eye, const glm::vec3& light) const override {
        const float density = pdf(eye, light); // cosθ/π
        return density > 0 ? reflectance_ * density * std::pow(std::abs(eye.z * light.z), k_ - 1)
                           : Rgb(0);
    }
    float pdf(const glm::vec3& eye, const glm::vec3& light) const override {
        return cosine_hemisphere_pdf(light.z * glm::sign(eye.z));
    }
    std::optional<BsdfSample> sample(const glm::vec3& eye, float,
                                     const glm::vec2& u) const override {
        if (eye.z == 0)
            return std::nullopt;
        glm::vec3 light = square_to_cosine_hemisphere(u);
        light.z = std::copysign(light.z, eye.z);
        const float density = pdf(eye, light);
        return BsdfSample{light, eval(eye, light) / density, density};
    }
    Rgb albedo(const glm::vec3& eye) const override {
        return reflectance_ * (2 * std::pow(std::abs(eye.z), k_ - 1) / (k_ + 1));
    }

  private:
    Rgb reflectance_;
    float k_;
};

std::shared_ptr<const Bsdf> make_minnaert(const MaterialContext& context) {
    const float k = context.params.get_float("darkening", 1);
    if (!(k >= 1))
        context.params.fail("darkening", "a number >= 1", std::to_string(k));
    return std::make_shared<Minnaert>(context.params.get_rgb("reflectance", Rgb(0.5f)), k);
}

const Registered<MaterialFactory> registered("minnaert", make_minnaert);

} // namespace
