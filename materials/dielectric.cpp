#include "materials/bsdf.h"
#include "renderer/core/fresnel.h"

#include <cmath>
#include <fmt/format.h>

namespace rapport {
namespace {

/// A smooth boundary, as of glass: Fresnel's equations, Snell's law. The face side is outside.
///     "float eta"        refractive index inside over that outside; default 1.5
///     "float roughness"  must be 0, pbrt's default
/// Radiances are divided by the square of their medium's index, so that refraction leaves them as
/// they are; true for lights and cameras outside.
class Dielectric final : public Bsdf {
  public:
    explicit Dielectric(float eta) : eta_(eta) {}

    Rgb eval(const glm::vec3&, const glm::vec3&) const override { return Rgb(0); }
    float pdf(const glm::vec3&, const glm::vec3&) const override { return 0; }

    std::optional<BsdfSample> sample(const glm::vec3& eye, float choice,
                                     const glm::vec2&) const override {
        if (eye.z == 0)
            return std::nullopt;
        const float eta = eye.z > 0 ? 1 / eta_ : eta_; // of the eye's side over the other's
        const FresnelResult fresnel = fresnel_dielectric(std::min(std::abs(eye.z), 1.0f), eta);
        if (choice < fresnel.reflectance)
            return BsdfSample{{-eye.x, -eye.y, eye.z}, Rgb(1), kMirror};
        const auto z = static_cast<float>(fresnel.cos_transmitted);
        return BsdfSample{
            glm::normalize(glm::vec3(-eta * eye.x, -eta * eye.y, -std::copysign(z, eye.z))), Rgb(1),
            kMirror};
    }

    Rgb albedo(const glm::vec3&) const override { return Rgb(1); }

  private:
    float eta_;
};

std::shared_ptr<const Bsdf> make_dielectric(const MaterialContext& context) {
    const float eta = context.params.get_float("eta", 1.5f);
    if (!(eta > 0))
        context.params.fail("eta", "an index above 0", fmt::format("{}", eta));
    if (const float roughness = context.params.get_float("roughness", 0); roughness != 0)
        context.params.fail("roughness", "0: a smooth boundary", fmt::format("{}", roughness));
    return std::make_shared<Dielectric>(eta);
}

const Registered<MaterialFactory> registered("dielectric", make_dielectric);

} // namespace
} // namespace rapport
