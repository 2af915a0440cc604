#pragma once

#include "materials/bsdf.h"

#include <algorithm>
#include <vector>

namespace rapport {

/// Normals of a rough surface: GGX of roughness α along x and y, with Smith's masking (Walter et
/// al. 2007; Heitz 2014 where the two differ), visible normals sampled by spherical caps (Dupuy &
/// Benyoub 2023). Directions have z > 0, except that masking is that of |z|.
class Ggx {
  public:
    Ggx(float alpha_x, float alpha_y) : x_(alpha_x), y_(alpha_y) {}
    /// pbrt's parameters:
    ///     "float roughness"               0 = smooth (default), to 1
    ///     "float uroughness", "float vroughness"   along u and v; default `roughness`
    ///     "bool remaproughness"           α = √roughness (default); else α = roughness
    explicit Ggx(const Params& params);

    /// Below this α, floats cannot hold the density; the lobe is narrower than 0.1°.
    static constexpr float kSmooth = 1e-3f;
    bool smooth() const { return std::max(x_, y_) < kSmooth; }
    bool isotropic() const { return x_ == y_; }

    /// Of normals over the microsurface, [1/sr].
    float density(const glm::vec3& normal) const;
    /// Of those that `w` sees.
    float visible_density(const glm::vec3& w, const glm::vec3& normal) const {
        return density(normal) * glm::dot(w, normal) / w.z * unmasked(w);
    }
    glm::vec3 sample_visible(const glm::vec3& w, const glm::vec2& u) const;

    /// Share of the microsurface, as seen from `w`, that nothing hides.
    float unmasked(const glm::vec3& w) const { return 1 / (1 + lambda(w)); }
    /// The same for what both see.
    float unmasked(const glm::vec3& a, const glm::vec3& b) const {
        return 1 / (1 + lambda(a) + lambda(b));
    }

  private:
    float lambda(const glm::vec3& w) const;

    float x_, y_;
};

/// Share of light that a rough surface scatters, by the mean of the weights of `Bsdf::sample`; the
/// rest would have met the surface again, which is not followed. Linear between its steps of cosθ,
/// nearest in φ, which it takes to be mirrored by both axes.
class AlbedoTable {
  public:
    /// With one φ where the surface is isotropic.
    AlbedoTable(const Bsdf& bsdf, bool isotropic);
    Rgb operator()(const glm::vec3& eye) const;

  private:
    static constexpr int kCosines = 33, kPhis = 9;
    const Rgb& at(int side, int phi, int cosine) const {
        return values_[static_cast<size_t>((side * phis_ + phi) * kCosines + cosine)];
    }

    int phis_;
    std::vector<Rgb> values_; ///< [side, φ over a quarter turn, cosθ]
};

} // namespace rapport
