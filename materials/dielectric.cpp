#include "materials/ggx.h"
#include "renderer/core/fresnel.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

namespace rapport {
namespace {

/// A boundary, as of glass: Fresnel's equations, Snell's law. The face side is outside.
///     "float eta"                     refractive index inside over that outside; default 1.5
///     "float roughness", …            see Ggx
/// Radiances are divided by the square of their medium's index, so that refraction leaves them as
/// they are; true for lights and cameras outside. With that, what is scattered is the density of
/// the visible normals (Walter et al. 2007, eq. 16 and 17) times Fresnel's share and the light's
/// own masking. Light that meets the rough boundary twice is lost, as in pbrt.
class Dielectric final : public Bsdf {
  public:
    Dielectric(float eta, const Ggx& ggx)
        : eta_(eta), ggx_(ggx), smooth_(ggx.smooth() || eta == 1) {
        if (!smooth_)
            albedo_.emplace(*this, ggx.isotropic());
    }

    Rgb eval(const glm::vec3& eye, const glm::vec3& light) const override {
        return eval_and_pdf(eye, light).value;
    }
    float pdf(const glm::vec3& eye, const glm::vec3& light) const override {
        return eval_and_pdf(eye, light).pdf;
    }

    BsdfValue eval_and_pdf(const glm::vec3& eye, const glm::vec3& light) const override {
        if (smooth_ || eye.z == 0 || light.z == 0)
            return {Rgb(0), 0};
        const float eta = index_at(eye);
        const glm::vec3 e = towards_eye(eye, eye), l = towards_eye(eye, light);
        const bool reflected = l.z > 0;
        glm::vec3 normal = glm::normalize(reflected ? e + l : eta * e + l);
        if (normal.z < 0)
            normal = -normal;
        const float e_normal = glm::dot(e, normal), l_normal = glm::dot(l, normal);
        if (!(e_normal > 0) || (l_normal > 0) != reflected)
            return {Rgb(0), 0};
        const auto reflectance = static_cast<float>(fresnel_at(e_normal, eta).reflectance);
        // Of the normal's solid angle over that of the light.
        const float jacobian =
            reflected ? 0.25f / e_normal : -l_normal / square(eta * e_normal + l_normal);
        const float pdf = ggx_.visible_density(e, normal) * jacobian *
                          (reflected ? reflectance : 1 - reflectance);
        return {Rgb(pdf * ggx_.unmasked(e, l) / ggx_.unmasked(e)), pdf};
    }

    std::optional<BsdfSample> sample(const glm::vec3& eye, float choice,
                                     const glm::vec2& u) const override {
        if (eye.z == 0)
            return std::nullopt;
        const float eta = index_at(eye);
        const glm::vec3 e = towards_eye(eye, eye);
        const glm::vec3 normal = smooth_ ? glm::vec3(0, 0, 1) : ggx_.sample_visible(e, u);
        const float e_normal = glm::dot(e, normal);
        const FresnelResult fresnel = fresnel_at(e_normal, eta);
        const bool reflected = choice < fresnel.reflectance;
        if (smooth_ && reflected)
            return BsdfSample{{-eye.x, -eye.y, eye.z}, Rgb(1), kMirror};
        const auto transmitted = static_cast<float>(fresnel.cos_transmitted);
        const glm::vec3 l =
            glm::normalize(reflected ? 2 * e_normal * normal - e
                                     : (eta * e_normal - transmitted) * normal - eta * e);
        const glm::vec3 light = towards_eye(eye, l);
        if (smooth_)
            return BsdfSample{light, Rgb(1), kMirror};
        if ((l.z > 0) != reflected)
            return std::nullopt;
        const auto [value, density] = eval_and_pdf(eye, light);
        if (!(density > 0))
            return std::nullopt;
        return BsdfSample{light, value / density, density};
    }

    Rgb albedo(const glm::vec3& eye) const override { return albedo_ ? (*albedo_)(eye) : Rgb(1); }

  private:
    /// Of the eye's side over the other's.
    float index_at(const glm::vec3& eye) const { return eye.z > 0 ? 1 / eta_ : eta_; }
    /// Mirrored where that brings the eye above the surface.
    static glm::vec3 towards_eye(const glm::vec3& eye, const glm::vec3& w) {
        return {w.x, w.y, std::copysign(1.0f, eye.z) * w.z};
    }
    static FresnelResult fresnel_at(float cosine, float eta) {
        return fresnel_dielectric(std::clamp(cosine, 0.0f, 1.0f), eta);
    }

    float eta_;
    Ggx ggx_;
    bool smooth_;
    std::optional<AlbedoTable> albedo_;
};

std::shared_ptr<const Bsdf> make_dielectric(const MaterialContext& context) {
    const float eta = context.params.get_float("eta", 1.5f);
    if (!(eta > 0))
        context.params.fail("eta", "an index above 0", fmt::format("{}", eta));
    return std::make_shared<Dielectric>(eta, Ggx(context.params));
}

const Registered<MaterialFactory> registered("dielectric", make_dielectric);

} // namespace
} // namespace rapport
