#include "materials/ggx.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

namespace rapport {
namespace {

constexpr auto kPiFloat = static_cast<float>(kPi);

float roughness(const Params& params, const char* name, float fallback) {
    const float value = params.get_float(name, fallback);
    if (!(value >= 0 && value <= 1))
        params.fail(name, "a number in [0, 1]", fmt::format("{}", value));
    return value;
}

} // namespace

Ggx::Ggx(const Params& params) {
    const float both = roughness(params, "roughness", 0);
    x_ = roughness(params, "uroughness", both);
    y_ = roughness(params, "vroughness", both);
    if (params.get_bool("remaproughness", true)) {
        x_ = std::sqrt(x_);
        y_ = std::sqrt(y_);
    }
    if (!smooth()) { // a mirror in one direction alone would have no density either
        x_ = std::max(x_, kSmooth);
        y_ = std::max(y_, kSmooth);
    }
}

float Ggx::density(const glm::vec3& normal) const {
    return 1 / (kPiFloat * x_ * y_ *
                square(square(normal.x / x_) + square(normal.y / y_) + square(normal.z)));
}

glm::vec3 Ggx::sample_visible(const glm::vec3& w, const glm::vec2& u) const {
    const glm::vec3 seen = glm::normalize(glm::vec3(x_ * w.x, y_ * w.y, w.z));
    const float phi = 2 * kPiFloat * u.x;
    const float z = (1 - u.y) * (1 + seen.z) - seen.z;
    const float sine = safe_sqrt(1 - z * z);
    const glm::vec3 half = seen + glm::vec3(sine * std::cos(phi), sine * std::sin(phi), z);
    return glm::normalize(glm::vec3(x_ * half.x, y_ * half.y, half.z));
}

float Ggx::lambda(const glm::vec3& w) const {
    const float tan2 = (square(x_ * w.x) + square(y_ * w.y)) / square(w.z);
    return 0.5f * (std::sqrt(1 + tan2) - 1);
}

AlbedoTable::AlbedoTable(const Bsdf& bsdf, bool isotropic) : phis_(isotropic ? 1 : kPhis) {
    constexpr int kSteps = 20;
    constexpr double kGoldenRatio = 0.6180339887498949; // spreads the choices over the steps
    for (int side = 0; side < 2; ++side)
        for (int phi = 0; phi < phis_; ++phi)
            for (int cosine = 0; cosine < kCosines; ++cosine) {
                const float z = std::max(static_cast<float>(cosine) / (kCosines - 1), 1e-3f);
                const float angle = phis_ == 1 ? 0 : 0.5f * kPiFloat * phi / (kPhis - 1);
                const float sine = safe_sqrt(1 - z * z);
                const glm::vec3 eye(sine * std::cos(angle), sine * std::sin(angle),
                                    side == 0 ? z : -z);
                Rgb sum(0);
                double turn = 0;
                for (int i = 0; i < kSteps; ++i)
                    for (int j = 0; j < kSteps; ++j) {
                        turn += kGoldenRatio;
                        const auto choice = static_cast<float>(turn - std::floor(turn));
                        if (const auto one =
                                bsdf.sample(eye, choice, (glm::vec2(i, j) + 0.5f) / float{kSteps}))
                            sum += one->weight;
                    }
                values_.push_back(sum / static_cast<float>(kSteps * kSteps));
            }
}

Rgb AlbedoTable::operator()(const glm::vec3& eye) const {
    const float quarter = std::atan2(std::abs(eye.y), std::abs(eye.x)) / (0.5f * kPiFloat);
    const int phi = static_cast<int>(std::lround(quarter * static_cast<float>(phis_ - 1)));
    const float place = std::min(std::abs(eye.z), 1.0f) * (kCosines - 1);
    const int cosine = std::min(static_cast<int>(place), kCosines - 2);
    const int side = eye.z < 0 ? 1 : 0;
    return glm::mix(at(side, phi, cosine), at(side, phi, cosine + 1),
                    place - static_cast<float>(cosine));
}

} // namespace rapport
