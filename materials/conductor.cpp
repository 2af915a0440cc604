#include "materials/ggx.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

namespace rapport {
namespace {

/// Reflectance of a smooth metal of index eta + i k for unpolarised light: Fresnel's equations in
/// real numbers (Born & Wolf, Principles of Optics, on metals: a² + b² and a stand for |n² − sin²θ|
/// and the real part of its root).
float fresnel_conductor(float cosine, float eta, float k) {
    const float cosine2 = std::min(square(cosine), 1.0f), sine2 = 1 - cosine2;
    const float t = square(eta) - square(k) - sine2;
    const float a2_b2 = std::sqrt(square(t) + 4 * square(eta * k));
    const float a = safe_sqrt(0.5f * (a2_b2 + t));
    const float s_sum = a2_b2 + cosine2, s_difference = 2 * a * cosine;
    const float p_sum = cosine2 * a2_b2 + square(sine2), p_difference = s_difference * sine2;
    const float s = (s_sum - s_difference) / (s_sum + s_difference);
    return 0.5f * s * (1 + (p_sum - p_difference) / (p_sum + p_difference));
}

/// A metal; both sides reflect. Light that would be reflected twice within the roughness is lost,
/// as in pbrt.
///     "rgb eta", "rgb k"     real and imaginary part of the refractive index; or
///     "rgb reflectance"      at normal incidence, each in [0, 1); default 0.9
///     "float roughness", …   see Ggx
class Conductor final : public Bsdf {
  public:
    Conductor(const Rgb& eta, const Rgb& k, const Ggx& ggx) : eta_(eta), k_(k), ggx_(ggx) {
        if (!ggx.smooth())
            albedo_.emplace(*this, ggx.isotropic());
    }

    Rgb eval(const glm::vec3& eye, const glm::vec3& light) const override {
        return eval_and_pdf(eye, light).value;
    }
    float pdf(const glm::vec3& eye, const glm::vec3& light) const override {
        return eval_and_pdf(eye, light).pdf;
    }

    BsdfValue eval_and_pdf(const glm::vec3& eye, const glm::vec3& light) const override {
        if (ggx_.smooth() || !(eye.z * light.z > 0))
            return {Rgb(0), 0};
        const glm::vec3 e = upright(eye), l = upright(light), normal = glm::normalize(e + l);
        const float cosine = glm::dot(e, normal);
        const float pdf = ggx_.visible_density(e, normal) / (4 * cosine);
        return {fresnel(cosine) * (pdf * ggx_.unmasked(e, l) / ggx_.unmasked(e)), pdf};
    }

    std::optional<BsdfSample> sample(const glm::vec3& eye, float,
                                     const glm::vec2& u) const override {
        if (eye.z == 0)
            return std::nullopt;
        if (ggx_.smooth())
            return BsdfSample{{-eye.x, -eye.y, eye.z}, fresnel(std::abs(eye.z)), kMirror};
        const glm::vec3 e = upright(eye), normal = ggx_.sample_visible(e, u);
        glm::vec3 light = glm::normalize(2 * glm::dot(e, normal) * normal - e);
        if (!(light.z > 0))
            return std::nullopt;
        light.z = std::copysign(light.z, eye.z);
        const auto [value, density] = eval_and_pdf(eye, light);
        if (!(density > 0))
            return std::nullopt;
        return BsdfSample{light, value / density, density};
    }

    Rgb albedo(const glm::vec3& eye) const override {
        return albedo_ ? (*albedo_)(eye) : fresnel(std::min(std::abs(eye.z), 1.0f));
    }

  private:
    static glm::vec3 upright(const glm::vec3& w) { return {w.x, w.y, std::abs(w.z)}; }
    Rgb fresnel(float cosine) const {
        Rgb share;
        for (int c = 0; c < 3; ++c)
            share[c] = fresnel_conductor(cosine, eta_[c], k_[c]);
        return share;
    }

    Rgb eta_, k_;
    Ggx ggx_;
    std::optional<AlbedoTable> albedo_;
};

std::shared_ptr<const Bsdf> make_conductor(const MaterialContext& context) {
    const Params& params = context.params;
    Rgb eta(1), k;
    if (params.has("eta") || params.has("k")) {
        if (params.has("reflectance"))
            params.fail("reflectance", "either eta and k, or reflectance", "both");
        eta = params.get_rgb("eta", Rgb(1));
        k = params.get_rgb("k", Rgb(1));
        for (int c = 0; c < 3; ++c)
            if (!(eta[c] > 0 && k[c] >= 0))
                params.fail(eta[c] > 0 ? "k" : "eta", "an index with eta above 0 and k not below",
                            fmt::format("{} + {} i", eta[c], k[c]));
    } else {
        const Rgb reflectance = params.get_rgb("reflectance", Rgb(0.9f));
        for (int c = 0; c < 3; ++c) {
            if (!(reflectance[c] >= 0 && reflectance[c] < 1))
                params.fail("reflectance", "numbers in [0, 1)", fmt::format("{}", reflectance[c]));
            k[c] = 2 * std::sqrt(reflectance[c] / (1 - reflectance[c])); // with eta = 1
        }
    }
    return std::make_shared<Conductor>(eta, k, Ggx(params));
}

const Registered<MaterialFactory> registered("conductor", make_conductor);

} // namespace
} // namespace rapport
