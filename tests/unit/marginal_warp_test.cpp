#include "materials/table/marginal_warp.h"

#include "renderer/core/rng.h"

#include <gtest/gtest.h>

namespace rapport {
namespace {

constexpr size_t kRows = 4, kColumns = 5;

/// Two slices: bumps, rows and cells of zeros among them, and one that is 0 throughout.
MarginalWarp warp() {
    std::vector<float> values = {0, 0, 0, 0, 0, 1, 0, 0, 2, 3, 9, 1, 0, 0, 4, 2, 2, 2, 0, 0};
    values.resize(2 * kRows * kColumns);
    return {values, kRows, kColumns};
}

const SliceBlend kFirst{{0}, {1}}, kMixed{{0, 1}, {0.7f, 0.3f}};

TEST(MarginalWarp, SamplesAndInvertsEachOther) {
    CounterRng rng(1, Purpose::test, 0, 0);
    for (const SliceBlend& blend : {kFirst, kMixed})
        for (int i = 0; i < 10000; ++i) {
            const glm::vec2 u(rng.uniform_float(), rng.uniform_float());
            const auto there = warp().sample(blend, u);
            const auto back = warp().invert(blend, there.position);
            ASSERT_NEAR(back.position.x, u.x, 2e-4);
            ASSERT_NEAR(back.position.y, u.y, 1e-5);
            ASSERT_NEAR(back.pdf, there.pdf, 1e-3f * (1 + there.pdf));
            ASSERT_NEAR(warp().pdf(blend, there.position), there.pdf, 1e-3f * (1 + there.pdf));
        }
}

TEST(MarginalWarp, DensityIsTheJacobian) {
    // pdf = |d sample⁻¹ / d position|, by central differences inside a cell.
    constexpr float kStep = 1e-3f;
    for (const glm::vec2 at : {glm::vec2(0.1, 0.8), {0.6, 0.45}, {0.9, 0.6}, {0.3, 0.9}}) {
        const auto invert = [&](float x, float y) {
            return warp().invert(kMixed, at + glm::vec2(x, y)).position;
        };
        const glm::vec2 dx = (invert(kStep, 0) - invert(-kStep, 0)) / (2 * kStep);
        const glm::vec2 dy = (invert(0, kStep) - invert(0, -kStep)) / (2 * kStep);
        EXPECT_NEAR(dx.x * dy.y - dx.y * dy.x, warp().pdf(kMixed, at), 5e-3);
    }
}

TEST(MarginalWarp, DensityIntegratesToOneAndASliceOfZerosIsUniform) {
    double sum = 0;
    constexpr int kSteps = 300;
    for (int i = 0; i < kSteps; ++i)
        for (int j = 0; j < kSteps; ++j)
            sum += warp().pdf(kMixed, {(i + 0.5f) / kSteps, (j + 0.5f) / kSteps});
    EXPECT_NEAR(sum / (kSteps * kSteps), 1, 1e-4);
    EXPECT_FLOAT_EQ(warp().pdf({{1}, {1}}, {0.3f, 0.2f}), 1);
    EXPECT_NEAR(warp().sample({{1}, {1}}, {0.3f, 0.2f}).position.x, 0.3f, 1e-6);
}

TEST(MarginalWarp, SlicesAreBlendedBilinearlyAndHeldBeyondTheEnds) {
    const std::vector<float> outer = {-1, 0, 2}, inner = {5, 6};
    const SliceBlend inside = blend_slices(outer, 1.5f, inner, 5.25f);
    double sum = 0, at_outer = 0, at_inner = 0;
    for (size_t k = 0; k < 4; ++k) {
        sum += inside.weight[k];
        at_outer += inside.weight[k] * outer[inside.slice[k] / 2];
        at_inner += inside.weight[k] * inner[inside.slice[k] % 2];
    }
    EXPECT_FLOAT_EQ(static_cast<float>(sum), 1);
    EXPECT_FLOAT_EQ(static_cast<float>(at_outer), 1.5f);
    EXPECT_FLOAT_EQ(static_cast<float>(at_inner), 5.25f);
    EXPECT_EQ(blend_slices(outer, -7, inner, 9).slice[0], 1u);
    EXPECT_EQ(blend_slices(outer, 7, inner, 0).slice[0], 4u);
}

} // namespace
} // namespace rapport
