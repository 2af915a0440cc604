#include "renderer/integrator/folded_bsdf.h"

#include "renderer/core/rng.h"
#include "tests/support/small_scenes.h"

#include <gtest/gtest.h>

namespace rapport {
namespace {

constexpr float kTilt = 0.6f; ///< of the surface against the shading frame [rad]
const glm::vec3 kNormal(std::sin(kTilt), 0, std::cos(kTilt));

/// Calls check(sample) for many samples of a material seen from `eye`.
template <class Check> int sample_often(const FoldedBsdf& folded, const Check& check) {
    int found = 0;
    for (int i = 0; i < 20000; ++i) {
        CounterRng rng(1, Purpose::test, i, 0);
        const float choice = rng.uniform();
        const float u = rng.uniform();
        if (const auto sample = folded.sample(choice, {u, rng.uniform()})) {
            check(*sample);
            ++found;
        }
    }
    return found;
}

TEST(FoldedBsdf, SamplesHaveTheValueAndDensityThatAreEvaluated) {
    const auto white = tests::diffuse(1);
    const FoldedBsdf folded(*white, glm::normalize(glm::vec3(0.3f, 0.2f, 1)), kNormal);
    int turned = 0;
    const int found = sample_often(folded, [&](const BsdfSample& sample) {
        const auto [value, pdf] = folded.eval_and_pdf(sample.light);
        EXPECT_GT(glm::dot(sample.light, kNormal) * sample.light.z, 0);
        EXPECT_NEAR(sample.pdf, pdf, 1e-5f * pdf);
        EXPECT_NEAR(sample.weight.g, 1, 1e-5f); // nothing is lost
        turned += sample.light.z < 0 || pdf > 1.001f * white->pdf({0, 0, 1}, sample.light);
    });
    EXPECT_GT(found, 19990); // but for those along the surface
    EXPECT_GT(turned, 500) << "hardly any sample was mirrored";
}

/// Draws where it evaluates to nothing, as rounding makes of a narrow lobe's edge.
class EdgeOfALobe final : public Bsdf {
  public:
    Rgb eval(const glm::vec3&, const glm::vec3&) const override { return Rgb(0); }
    float pdf(const glm::vec3&, const glm::vec3&) const override { return 0; }
    std::optional<BsdfSample> sample(const glm::vec3&, float, const glm::vec2& u) const override {
        const float phi = 2 * static_cast<float>(kPi) * u.x, z = 0.999f * u.y + 0.001f;
        const float across = std::sqrt(1 - z * z);
        return BsdfSample{{across * std::cos(phi), across * std::sin(phi), z}, Rgb(0.5f), 4};
    }
    Rgb albedo(const glm::vec3&) const override { return Rgb(0.5f); }
};

TEST(FoldedBsdf, AFoldedSampleOfNoEvaluatedDensityKeepsItsOwn) {
    const EdgeOfALobe lobe;
    const FoldedBsdf folded(lobe, {0, 0, 1}, kNormal);
    sample_often(folded, [](const BsdfSample& sample) {
        EXPECT_EQ(sample.pdf, 4); // 0 would make the weight no number
        EXPECT_EQ(sample.weight.g, 0.5f);
    });
}

} // namespace
} // namespace rapport
