#include "renderer/core/rng.h"
#include "renderer/integrator/path_tracer.h"
#include "renderer/integrator/sample_plan.h"
#include "tests/support/long_run.h"
#include "tests/support/small_scenes.h"

#include <algorithm>
#include <gtest/gtest.h>
#include <numeric>

// The noise that a picture claims to have is the noise that it has, also where the noise decided
// how many samples were taken.

namespace rapport {
namespace {

/// A lamp that shines down on a cube and a floor, which leaves corners of the picture black: tiles
/// that need very different numbers of samples.
Scene lamp_scene(const RenderSettings& settings) {
    std::vector<Surface> surfaces{
        tests::surface(tests::level_square(2, -0.5f), tests::diffuse(0.6f)),
        tests::surface(tests::cube(0.5f), tests::diffuse(0.8f)),
        tests::surface(tests::parallelogram({-1.4f, 0.6f, 1}, {0, 0.4f, 0.1f}, {0.4f, 0, 0}),
                       tests::diffuse(0), 30)};
    return Scene(std::move(surfaces), {}, tests::parallel_camera({3, 4, 5}, {0, 0, 0}, 2.0f, 48),
                 settings);
}

RenderSettings to_error(double error, uint64_t seed,
                        Sampler::Kind sampler = Sampler::Kind::independent) {
    RenderSettings settings = tests::settings(0, 3, sampler, seed);
    settings.error = error;
    return settings;
}

TEST(RenderError, IsReachedWhereSamplesAreSpentWhereTheyAreNeeded) {
    const double error = 0.2;
    const Film film = render(lamp_scene(to_error(error, 1)));
    EXPECT_TRUE(reaches(film, error));
    EXPECT_GT(film.noise().relative(), 0.5 * error); // not far beyond what was asked
    int fewest = 1 << 30, most = 0;
    for (const Film::Tile& tile : film.tiles()) {
        fewest = std::min(fewest, tile.samples);
        most = std::max(most, tile.samples);
    }
    EXPECT_GT(most, 4 * fewest);
    // Spread evenly, as many samples leave more noise.
    const Film even = render(lamp_scene(
        tests::settings(static_cast<int>(film.mean_samples()), 3, Sampler::Kind::independent, 1)));
    EXPECT_FALSE(reaches(even, error));
}

void expect_honest(Sampler::Kind sampler) {
    const double error = 0.2;
    const int pictures = tests::long_run() ? 400 : 24;
    const Image truth = render(lamp_scene(tests::settings(tests::long_run() ? 65536 : 8192, 3,
                                                          Sampler::Kind::independent, 1'000'000)))
                            .image();
    const std::vector<float>& exact = *truth.find("G");
    const std::vector<float>& variance = *truth.find("variance.G");
    const double pixels = static_cast<double>(exact.size());
    const double mean = std::accumulate(exact.begin(), exact.end(), 0.0) / pixels;
    const double of_truth =
        std::accumulate(variance.begin(), variance.end(), 0.0) / pixels / square(mean);
    double claimed = 0, by_samples = 0, found = 0, offset = 0;
    for (int seed = 0; seed < pictures; ++seed) {
        const Film film = render(lamp_scene(to_error(error, static_cast<uint64_t>(seed), sampler)));
        claimed += square(film.noise().relative());
        const Image image = film.image();
        const std::vector<float>& values = *image.find("G");
        const std::vector<float>& of_samples = *image.find("variance.G");
        double squares = 0;
        for (size_t i = 0; i < exact.size(); ++i) {
            const double difference = (values[i] - exact[i]) / mean;
            squares += square(difference) / pixels;
            offset += difference / pixels / pictures;
            by_samples += of_samples[i] / square(mean) / pixels;
        }
        found += squares - of_truth;
    }
    const double ratio = std::sqrt(claimed / found);
    // 2304 pixels a picture, of which some hundreds carry most of the noise.
    const double tolerance = tests::long_run() ? 0.02 : 0.05;
    EXPECT_NEAR(ratio, 1, tolerance);
    EXPECT_GT(std::abs(ratio / std::sqrt(2.0) - 1), tolerance); // a claim of half the variance
    const double as_if_independent = std::sqrt(by_samples / found);
    if (sampler == Sampler::Kind::sobol) { // the wrong twin: Sobol points taken as independent ones
        EXPECT_GT(as_if_independent, 1 + 2 * tolerance);
    }
    // Stopping by the noise does not pull the mean.
    const double standard_error = std::sqrt((square(error) / pictures + of_truth) / pixels);
    EXPECT_LT(std::abs(offset), 4 * standard_error);
    std::printf("claimed over true: %.4f (samples taken as independent %.4f), offset of the mean "
                "%.2e\n",
                ratio, as_if_independent, offset);
}

TEST(RenderError, IsHonest) { expect_honest(Sampler::Kind::independent); }
TEST(RenderError, IsHonestOfSobolPoints) { expect_honest(Sampler::Kind::sobol); }

TEST(RenderError, AStoppedPictureIsWhole) {
    RenderWatcher watcher;
    watcher.stopped = [] { return true; };
    const Film film =
        render(lamp_scene(tests::settings(64, 3, Sampler::Kind::independent, 1)), watcher);
    for (const Film::Tile& tile : film.tiles())
        EXPECT_EQ(tile.samples, 1);
    const Image image = film.image();
    EXPECT_EQ(image.find("variance.R"), nullptr);
    EXPECT_GT(image.find("N.Z")->at(48 * 24 + 24), 0.1f);
}

/// The one tile in twenty that may stay noisier than asked, here a dark one, which counts for
/// little in the whole picture, has no fewer samples than the others.
TEST(SamplePlan, GivesNoTileUp) {
    constexpr int kTiles = 20, kSize = 16, kSamples = 16, kNoisiest = 7;
    Film film({kTiles * kSize, kSize});
    CounterRng rng(1, Purpose::test, 0, 0);
    for (int x = 0; x < kTiles * kSize; ++x)
        for (int y = 0; y < kSize; ++y)
            for (int number = 0; number < kSamples; ++number) {
                const float even = rng.uniform_float() - 0.5f;
                film.add(x, y, number,
                         {Rgb(x / kSize == kNoisiest ? 0.2f * (1 + 2 * even) : 1 + even)});
            }
    for (Film::Tile& tile : film.tiles())
        tile.samples = kSamples;
    const std::vector<int> plan = plan_samples(film, 0.05);
    // Of variance 1/12 per sample, known to 9 % from as many pixels, in all channels at once.
    EXPECT_NEAR(plan[0], 1.1 / 12 / square(0.05), 10);
    EXPECT_NEAR(plan[kNoisiest], *std::ranges::max_element(plan), 1);
    EXPECT_LT(plan[kNoisiest], 50); // and not the 147 that its own noise would ask for
}

TEST(SamplePlan, AsksForNothingOfABlackPicture) {
    const Scene dark({}, {}, tests::parallel_camera({0, 0, 2}, {0, 0, 0}, 1, 32),
                     to_error(0.01, 0));
    const Film film = render(dark);
    EXPECT_EQ(film.mean_samples(), 16);
    EXPECT_EQ(film.noise().relative(), 0);
}

} // namespace
} // namespace rapport
