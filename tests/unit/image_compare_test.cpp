#include "renderer/core/image.h"
#include "renderer/core/rng.h"
#include "tests/support/long_run.h"

#include <algorithm>
#include <cmath>
#include <gtest/gtest.h>
#include <limits>

using namespace rapport;

namespace {

constexpr int kSize = 32;
constexpr const char* kColour[] = {"R", "G", "B"};

/// One random sample with expectation `mean`.
using Noise = double (*)(double mean, CounterRng&);

double exponential(double mean, CounterRng& rng) { return -mean * std::log(rng.uniform()); }
double uniform(double mean, CounterRng& rng) { return mean * (0.5 + rng.uniform()); }
/// A path tracer's worst habit: most of the light in one sample of twenty.
double sparse(double mean, CounterRng& rng) {
    const double bright = rng.uniform() < 0.05 ? 12.8 : 0.4;
    return mean * bright / (0.05 * 12.8 + 0.95 * 0.4);
}
/// All or nothing: an edge that covers a tenth of the pixel.
double edge(double mean, CounterRng& rng) { return rng.uniform() < 0.1 ? 10 * mean : 0; }

/// The picture that the samples have in expectation: a checkerboard on a gradient, with a black
/// corner in which nothing varies.
double scene(int x, int y, int channel) {
    if (x < 8 && y < 8)
        return 0;
    return (0.2 + 0.01 * x + 0.1 * channel) * ((x / 6 + y / 6) % 2 ? 1 : 0.3);
}

/// A render of the scene by `samples` per pixel: mean and estimated variance of the mean.
Image render(uint64_t seed, int samples, const Noise& noise, double brightness = 1, int shift = 0) {
    Image image(kSize, kSize, {"R", "G", "B", "variance.R", "variance.G", "variance.B"});
    for (int y = 0; y < kSize; ++y)
        for (int x = 0; x < kSize; ++x) {
            CounterRng rng(seed, Purpose::test, y * kSize + x, samples);
            for (int c = 0; c < 3; ++c) {
                const double mean = brightness * scene(x + shift, y, c);
                double sum = 0, squares = 0;
                for (int s = 0; s < samples; ++s) {
                    const double value = noise(mean, rng);
                    sum += value;
                    squares += value * value;
                }
                sum /= samples;
                squares = std::max(0.0, squares / samples - sum * sum) / (samples - 1);
                image.data[c][y * kSize + x] = static_cast<float>(sum);
                image.data[3 + c][y * kSize + x] = static_cast<float>(squares);
            }
        }
    return image;
}

Image plain(std::vector<float> values) {
    Image image(static_cast<int>(values.size()), 1, {"R", "G", "B"});
    image.data.assign(3, values);
    return image;
}

} // namespace

TEST(Compare, Magnitudes) {
    Image a = plain({1, 2, 3, 4}), b = a;
    EXPECT_EQ(compare(a, b).max_absolute, 0);
    EXPECT_TRUE(compare(a, b).agree);
    (*b.find("G"))[2] = 5;
    const ImageDifference result = compare(a, b);
    EXPECT_FALSE(result.tested);
    EXPECT_FALSE(result.agree);
    EXPECT_EQ(result.max_absolute, 2);
    EXPECT_EQ(result.worst_x, 2);
    EXPECT_EQ(result.worst_y, 0);
    EXPECT_NEAR(result.mean_absolute, 2.0 / 12, 1e-15);
    EXPECT_NEAR(result.rms, std::sqrt(4.0 / 12), 1e-15);
    EXPECT_NEAR(result.relative_mse, 4.0 / (25 + 0.01) / 12, 1e-15);
}

TEST(Compare, RefusesImagesThatDoNotMatch) {
    EXPECT_THROW(compare(plain({1, 2}), plain({1, 2, 3})), std::invalid_argument);
    EXPECT_THROW(compare(plain({1, 2}), Image(2, 1, {"R", "G"})), std::invalid_argument);
    Image a = render(1, 16, uniform);
    const Image b = a;
    (*a.find("variance.G"))[9] = -1e-6f;
    EXPECT_THROW(compare(a, b), std::invalid_argument);
}

TEST(Compare, NothingFiniteHidesADifference) {
    const float nan = std::nanf(""), inf = std::numeric_limits<float>::infinity();
    EXPECT_FALSE(compare(plain({1, nan}), plain({1, nan})).agree);
    EXPECT_FALSE(compare(plain({1, inf}), plain({1, 2})).agree);
    EXPECT_TRUE(compare(plain({1, inf}), plain({1, inf})).agree);
    Image a = render(1, 16, uniform);
    const Image b = render(2, 16, uniform);
    (*a.find("B"))[100] = nan;
    EXPECT_FALSE(compare(a, b).agree);
    EXPECT_EQ(compare(a, b).p_value, 0);
}

TEST(Compare, WhereNothingVariesNothingMayDiffer) {
    Image a = render(1, 16, uniform), b = render(2, 16, uniform);
    EXPECT_TRUE(compare(a, b).agree);
    (*a.find("R"))[2] = 1e-4f; // in the black corner
    EXPECT_FALSE(compare(a, b).agree);
    (*a.find("R"))[2] = 0.7f;
    (*b.find("R"))[2] = std::nextafter(0.7f, 1.0f); // rounding is no difference
    EXPECT_TRUE(compare(a, b).agree);
}

// Two renders of one scene may be called different in 1 % of the cases, even with 16 samples of
// noise that is far from normal, and against a reference that has many more.
TEST(Compare, FalseAlarmsAreRare) {
    const int pairs = tests::long_run() ? 400 : 60;
    int alarms = 0, index = 0;
    for (const Noise& noise : {uniform, exponential, sparse, edge})
        for (const int reference_samples : {16, 128})
            for (int pair = 0; pair < pairs; ++pair) {
                const uint64_t seed = 10 * ++index;
                const ImageDifference result =
                    compare(render(seed, 16, noise), render(seed + 1, reference_samples, noise));
                EXPECT_TRUE(result.tested);
                alarms += !result.agree;
            }
    EXPECT_LE(alarms, 0.01 * 8 * pairs + 3 * std::sqrt(0.01 * 8 * pairs));
}

TEST(Compare, AnExactReferenceHasNoVariance) {
    Image exact = render(1, 16, [](double mean, CounterRng&) { return mean; });
    for (int c = 3; c < 6; ++c)
        exact.data[c].assign(kSize * kSize, 0.0f);
    int alarms = 0;
    for (int pair = 0; pair < 50; ++pair)
        alarms += !compare(render(10 + pair, 64, uniform), exact).agree;
    EXPECT_LE(alarms, 2);
    EXPECT_FALSE(compare(render(1, 64, uniform, 1.01), exact).agree);
}

TEST(Compare, WrongTwinsAreRejected) {
    int brighter = 0, shifted = 0, spotted = 0, stained = 0;
    constexpr int kPairs = 20;
    for (int pair = 0; pair < kPairs; ++pair) {
        const Image reference = render(pair, 64, exponential);
        // 1 % of brightness where a pixel's noise is 2.5 %: seen only in sums.
        brighter +=
            !compare(render(9000 + pair, 256, uniform, 1.01), render(8000 + pair, 256, uniform))
                 .agree;
        shifted += !compare(render(9000 + pair, 64, exponential, 1, 1), reference).agree;
        Image spot = render(7000 + pair, 64, exponential);
        spot.data[1][20 * kSize + 20] *= 6; // a single pixel
        spotted += !compare(spot, reference).agree;
        Image stain = render(6000 + pair, 64, exponential);
        for (int y = 24; y < 32; ++y)
            for (int x = 24; x < 32; ++x)
                stain.data[2][y * kSize + x] *= 1.15f; // a tile, by one to two sigma each
        stained += !compare(stain, reference).agree;
    }
    EXPECT_EQ(brighter, kPairs);
    EXPECT_EQ(shifted, kPairs);
    EXPECT_GE(spotted, 0.9 * kPairs);
    EXPECT_GE(stained, 0.9 * kPairs);
}
