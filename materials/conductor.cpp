#include "materials/bsdf.h"

#include <array>
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

/// Normals of a rough surface: GGX of roughness α with Smith's masking (Walter et al. 2007),
/// visible normals sampled by spherical caps (Dupuy & Benyoub 2023). Directions have z > 0.
class Ggx {
  public:
    explicit Ggx(float alpha) : alpha_(alpha) {}

    float density(const glm::vec3& normal) const {
        const float a2 = square(alpha_);
        return a2 / (static_cast<float>(kPi) *
                     square(square(normal.x) + square(normal.y) + a2 * square(normal.z)));
    }
    /// Share of the microsurface, as seen from `w`, that nothing hides.
    float unmasked(const glm::vec3& w) const { return 1 / (1 + lambda(w)); }
    float unmasked(const glm::vec3& a, const glm::vec3& b) const {
        return 1 / (1 + lambda(a) + lambda(b));
    }
    glm::vec3 sample(const glm::vec3& eye, const glm::vec2& u) const {
        const glm::vec3 seen = glm::normalize(glm::vec3(alpha_ * eye.x, alpha_ * eye.y, eye.z));
        const float phi = 2 * static_cast<float>(kPi) * u.x;
        const float z = (1 - u.y) * (1 + seen.z) - seen.z;
        const float sine = safe_sqrt(1 - z * z);
        const glm::vec3 half = seen + glm::vec3(sine * std::cos(phi), sine * std::sin(phi), z);
        return glm::normalize(glm::vec3(alpha_ * half.x, alpha_ * half.y, half.z));
    }

  private:
    float lambda(const glm::vec3& w) const {
        const float tan2 = (square(w.x) + square(w.y)) / square(w.z);
        return 0.5f * (std::sqrt(1 + square(alpha_) * tan2) - 1);
    }
    float alpha_;
};

/// A metal; both sides reflect. Light that would be reflected twice within the roughness is lost,
/// as in pbrt.
///     "rgb eta", "rgb k"     real and imaginary part of the refractive index; or
///     "rgb reflectance"      at normal incidence, each in [0, 1); default 0.9
///     "float roughness"      0 = a mirror (default)
///     "bool remaproughness"  α = √roughness (default); else α = roughness
class Conductor final : public Bsdf {
  public:
    Conductor(const Rgb& eta, const Rgb& k, float alpha)
        : eta_(eta), k_(k), ggx_(alpha), smooth_(alpha < kSmooth) {
        for (size_t i = 0; i < albedo_.size(); ++i)
            albedo_[i] = integrate(static_cast<float>(i) / (albedo_.size() - 1));
    }

    Rgb eval(const glm::vec3& eye, const glm::vec3& light) const override {
        if (smooth_ || !(eye.z * light.z > 0))
            return Rgb(0);
        const glm::vec3 e = upright(eye), l = upright(light), half = glm::normalize(e + l);
        return fresnel(glm::dot(e, half)) * (ggx_.density(half) / (4 * e.z) * ggx_.unmasked(e, l));
    }
    float pdf(const glm::vec3& eye, const glm::vec3& light) const override {
        if (smooth_ || !(eye.z * light.z > 0))
            return 0;
        const glm::vec3 e = upright(eye), half = glm::normalize(e + upright(light));
        return ggx_.density(half) / (4 * e.z) * ggx_.unmasked(e);
    }

    std::optional<BsdfSample> sample(const glm::vec3& eye, float,
                                     const glm::vec2& u) const override {
        if (eye.z == 0)
            return std::nullopt;
        if (smooth_)
            return BsdfSample{{-eye.x, -eye.y, eye.z}, fresnel(std::abs(eye.z)), kMirror};
        const glm::vec3 e = upright(eye), normal = ggx_.sample(e, u);
        glm::vec3 light = glm::normalize(2 * glm::dot(e, normal) * normal - e);
        if (!(light.z > 0))
            return std::nullopt;
        light.z = std::copysign(light.z, eye.z);
        const float density = pdf(eye, light);
        if (!(density > 0))
            return std::nullopt;
        return BsdfSample{light, eval(eye, light) / density, density};
    }

    Rgb albedo(const glm::vec3& eye) const override {
        const float place = std::min(std::abs(eye.z), 1.0f) * (albedo_.size() - 1);
        const auto i = std::min(static_cast<size_t>(place), albedo_.size() - 2);
        return glm::mix(albedo_[i], albedo_[i + 1], place - static_cast<float>(i));
    }

    /// Below this α, floats cannot hold the density; the lobe is narrower than 0.1°.
    static constexpr float kSmooth = 1e-3f;

  private:
    static glm::vec3 upright(const glm::vec3& w) { return {w.x, w.y, std::abs(w.z)}; }
    Rgb fresnel(float cosine) const {
        Rgb share;
        for (int c = 0; c < 3; ++c)
            share[c] = fresnel_conductor(cosine, eta_[c], k_[c]);
        return share;
    }
    /// Mean of the weights of `sample`, by midpoints.
    Rgb integrate(float cosine) const {
        constexpr int kSteps = 24;
        const float z = std::max(cosine, 1e-3f);
        const glm::vec3 eye(safe_sqrt(1 - z * z), 0, z);
        Rgb sum(0);
        for (int i = 0; i < kSteps; ++i)
            for (int j = 0; j < kSteps; ++j)
                if (const auto one = sample(eye, 0, (glm::vec2(i, j) + 0.5f) / float{kSteps}))
                    sum += one->weight;
        return sum / static_cast<float>(kSteps * kSteps);
    }

    Rgb eta_, k_;
    Ggx ggx_;
    bool smooth_;
    std::array<Rgb, 33> albedo_; ///< over cosθ
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
    const float roughness = params.get_float("roughness", 0);
    if (!(roughness >= 0 && roughness <= 1))
        params.fail("roughness", "a number in [0, 1]", fmt::format("{}", roughness));
    const bool remapped = params.get_bool("remaproughness", true);
    return std::make_shared<Conductor>(eta, k, remapped ? std::sqrt(roughness) : roughness);
}

const Registered<MaterialFactory> registered("conductor", make_conductor);

} // namespace
} // namespace rapport
