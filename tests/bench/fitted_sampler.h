#pragma once

#include "materials/bsdf.h"
#include "renderer/core/rng.h"

#include <algorithm>
#include <fmt/format.h>

namespace rapport::tests {

/// What a cloth is commonly sampled by: an anisotropic GGX lobe about the mirror direction (visible
/// normals by spherical caps, Dupuy & Benyoub 2023; Smith's masking), and Lambert's law to both
/// sides. Directions are on the side of the eye, z > 0 there.
struct Lobes {
    float alpha_x = 0.3f, alpha_y = 0.3f;
    float glossy = 0.4f, reflected = 0.3f; ///< shares of samples; the rest is transmitted

    float pdf(const glm::vec3& eye, const glm::vec3& light) const {
        const auto pi = static_cast<float>(kPi);
        if (light.z <= 0)
            return (1 - glossy - reflected) * -light.z / pi;
        const glm::vec3 half = glm::normalize(eye + light);
        const glm::vec3 slope(half.x / alpha_x, half.y / alpha_y, half.z);
        const float density = 1 / (pi * alpha_x * alpha_y * square(glm::dot(slope, slope)));
        const float stretched = std::hypot(alpha_x * eye.x, alpha_y * eye.y, eye.z);
        return reflected * light.z / pi + glossy * density / (2 * (eye.z + stretched));
    }

    /// Below the horizon of either side, a GGX direction is lost.
    std::optional<glm::vec3> sample(const glm::vec3& eye, float choice, const glm::vec2& u) const {
        const float phi = 2 * static_cast<float>(kPi) * u.x;
        if (choice < glossy) {
            const glm::vec3 seen =
                glm::normalize(glm::vec3(alpha_x * eye.x, alpha_y * eye.y, eye.z));
            const float z = (1 - u.y) * (1 + seen.z) - seen.z, sine = safe_sqrt(1 - z * z);
            const glm::vec3 cap = seen + glm::vec3(sine * std::cos(phi), sine * std::sin(phi), z);
            const glm::vec3 half =
                glm::normalize(glm::vec3(alpha_x * cap.x, alpha_y * cap.y, cap.z));
            const glm::vec3 light = 2 * glm::dot(eye, half) * half - eye;
            if (!(light.z > 0))
                return std::nullopt;
            return light;
        }
        const float radius = std::sqrt(u.y), z = std::max(safe_sqrt(1 - u.y), 1e-6f);
        return glm::vec3(radius * std::cos(phi), radius * std::sin(phi),
                         choice < glossy + reflected ? z : -z);
    }
};

/// The cloth that it is given, sampled by lobes that are fitted to it, those of front and back
/// apart: of least ∫ p²/q, p the density that the table samples with and q that of the lobes, in
/// the mean over eyes that are seen evenly (∝ cosθ). It is 1 + the relative variance of the cloth's
/// albedo when estimated by q under an even sky.
class FittedSampler final : public Bsdf {
  public:
    explicit FittedSampler(std::shared_ptr<const Bsdf> cloth) : cloth_(std::move(cloth)) {
        for (const int side : {0, 1})
            fit(side);
    }

    Rgb eval(const glm::vec3& eye, const glm::vec3& light) const override {
        return cloth_->eval(eye, light);
    }
    float pdf(const glm::vec3& eye, const glm::vec3& light) const override {
        const float side = eye.z > 0 ? 1.0f : -1.0f;
        return lobes_[eye.z > 0 ? 0 : 1].pdf(with_side(eye, side), with_side(light, side));
    }
    std::optional<BsdfSample> sample(const glm::vec3& eye, float choice,
                                     const glm::vec2& u) const override {
        if (eye.z == 0)
            return std::nullopt;
        const float side = eye.z > 0 ? 1.0f : -1.0f;
        const Lobes& lobes = lobes_[eye.z > 0 ? 0 : 1];
        const auto there = lobes.sample(with_side(eye, side), choice, u);
        if (!there)
            return std::nullopt;
        const float density = lobes.pdf(with_side(eye, side), *there);
        const glm::vec3 light = with_side(*there, side);
        return BsdfSample{light, cloth_->eval(eye, light) / density, density};
    }
    Rgb unscattered(const glm::vec3& eye) const override { return cloth_->unscattered(eye); }
    Rgb albedo(const glm::vec3& eye) const override { return cloth_->albedo(eye); }

    std::string describe() const {
        std::string text = "GGX";
        for (const int side : {0, 1})
            text += fmt::format(
                "{} {}: α {:.3f} along the weft, {:.3f} along the warp; shares: GGX "
                "{:.2f}, reflected {:.2f}, transmitted {:.2f}; ∫p²/q {:.2f}",
                side == 0 ? "" : ";", side == 0 ? "front" : "back", lobes_[side].alpha_x,
                lobes_[side].alpha_y, lobes_[side].glossy, lobes_[side].reflected,
                1 - lobes_[side].glossy - lobes_[side].reflected, misfit_[side]);
        return text;
    }

  private:
    /// z turned round where the eye is on the back; x and y are the same on both sides.
    static glm::vec3 with_side(const glm::vec3& w, float side) { return {w.x, w.y, side * w.z}; }

    struct Draw {
        glm::vec3 eye, light;
        float pdf;
    };

    std::vector<Draw> draws(float side) const {
        std::vector<Draw> all;
        CounterRng rng(1, Purpose::test, side > 0 ? 0 : 1, 0);
        for (int e = 0; e < 64; ++e) {
            const float z = std::sqrt(rng.uniform_float());
            const glm::vec3 eye = spherical_direction(std::acos(z), static_cast<float>(2 * kPi) *
                                                                        rng.uniform_float());
            for (int l = 0; l < 256; ++l)
                if (const auto sample = cloth_->sample(with_side(eye, side), rng.uniform_float(),
                                                       {rng.uniform_float(), rng.uniform_float()}))
                    all.push_back({eye, with_side(sample->light, side), sample->pdf});
        }
        return all;
    }

    static double misfit(const std::vector<Draw>& draws, const Lobes& lobes) {
        double sum = 0;
        for (const Draw& draw : draws)
            sum += draw.pdf / lobes.pdf(draw.eye, draw.light);
        return sum / static_cast<double>(draws.size());
    }

    /// Pattern search over the logarithms of the four numbers, from three shapes of the lobe.
    void fit(int side) {
        const std::vector<Draw> all = draws(side == 0 ? 1.0f : -1.0f);
        const auto lobes_of = [](const std::array<double, 4>& x) {
            const double glossy = std::exp(x[2]), reflected = std::exp(x[3]);
            const double sum = 1 + glossy + reflected;
            return Lobes{static_cast<float>(std::exp(x[0])), static_cast<float>(std::exp(x[1])),
                         static_cast<float>(glossy / sum), static_cast<float>(reflected / sum)};
        };
        misfit_[side] = std::numeric_limits<double>::infinity();
        for (std::array<double, 4> best :
             {std::array{-2.5, -0.5, 0.0, 0.0}, {-0.5, -2.5, 0.0, 0.0}, {-1.0, -1.0, 0.0, 0.0}}) {
            double least = misfit(all, lobes_of(best));
            for (double step = 1; step > 0.02;) {
                bool improved = false;
                for (size_t i = 0; i < best.size(); ++i)
                    for (const double sign : {1.0, -1.0}) {
                        std::array<double, 4> tried = best;
                        tried[i] += sign * step;
                        if (const double found = misfit(all, lobes_of(tried)); found < least) {
                            least = found;
                            best = tried;
                            improved = true;
                        }
                    }
                if (!improved)
                    step /= 2;
            }
            if (least < misfit_[side]) {
                misfit_[side] = least;
                lobes_[side] = lobes_of(best);
            }
        }
    }

    std::shared_ptr<const Bsdf> cloth_;
    std::array<Lobes, 2> lobes_;
    std::array<double, 2> misfit_{};
};

} // namespace rapport::tests
