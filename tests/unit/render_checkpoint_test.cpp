#include "renderer/core/error.h"
#include "renderer/core/image.h"
#include "renderer/core/input_file.h"
#include "renderer/core/parallel.h"
#include "renderer/core/rng.h"
#include "renderer/integrator/path_tracer.h"
#include "tests/support/file_bytes.h"
#include "tests/support/run_program.h"
#include "tests/support/small_scenes.h"
#include "tests/support/temporary_folder.h"

#include <atomic>
#include <chrono>
#include <cstring>
#include <fstream>
#include <gtest/gtest.h>
#include <unistd.h>

namespace rapport {
namespace {

/// A lamp over a floor, whose tiles want very different numbers of samples.
Scene lamp_scene(const RenderSettings& settings, const glm::ivec2& resolution = {100, 90}) {
    std::vector<Surface> surfaces{
        tests::surface(tests::level_square(2, 0), tests::diffuse(0.6f)),
        tests::surface(tests::level_square(0.1f, 0.3f), tests::diffuse(0), 5)};
    tests::turn_over(surfaces[1]);
    Camera camera = tests::parallel_camera({1, -2, 3}, {0, 0, 0}, 1.5f, 1);
    camera.resolution = resolution;
    return Scene(std::move(surfaces), {tests::sky(0.1f)}, camera, settings);
}

RenderSettings to_samples() { return tests::settings(70, 3, Sampler::Kind::sobol, 4); }
RenderSettings to_error() {
    RenderSettings settings = to_samples();
    settings.error = 0.006;
    return settings;
}

class RenderCheckpointed : public testing::TestWithParam<RenderSettings> {
  protected:
    /// Renders until `tiles` more have been sampled, or to the end; whether that was reached.
    bool run(int tiles, const Scene& scene, Image& image,
             const std::map<std::string, std::string>& made_of = {{"file scene.pbrt", "1"}}) {
        std::atomic<int> left = tiles;
        RenderWatcher watcher;
        watcher.progress = [&](double fraction, double) {
            EXPECT_LE(fraction, 1 + 1e-9);
            --left;
        };
        watcher.stopped = [&] { return left <= 0; };
        image = render(scene, watcher, {{part_, true}, made_of}).image();
        return left > 0;
    }

    /// Where the checkpoint of a few tiles is refused by another run.
    std::string refusal(const Scene& scene, const std::map<std::string, std::string>& made_of = {
                                                {"file scene.pbrt", "1"}}) {
        Image image;
        try {
            run(1, scene, image, made_of);
        } catch (const FileError& error) {
            return error.place;
        }
        return "accepted";
    }

    const tests::TemporaryFolder folder_;
    const std::filesystem::path part_ = folder_ / "picture.exr.part";
};

TEST_P(RenderCheckpointed, PicturesThatAreInterruptedEndWithTheSamePixels) {
    const Scene scene = lamp_scene(GetParam());
    const Image whole = render(scene).image();
    Image image;
    int runs = 0;
    // The first sample of every tile is taken in any case, so that all runs have some to add.
    for (bool done = false; !done; ++runs) {
        set_thread_count(1 + runs % 3);
        done = run(42 + 17 * runs, scene, image);
        ASSERT_LT(runs, 100);
    }
    set_thread_count(0);
    EXPECT_GE(runs, 3);
    EXPECT_EQ(image.data, whole.data);
}

TEST_P(RenderCheckpointed, WhatBelongsToAnotherPictureIsRefusedByName) {
    Image image;
    ASSERT_FALSE(run(50, lamp_scene(GetParam()), image));
    EXPECT_EQ(refusal(lamp_scene(GetParam())), "accepted");
    EXPECT_EQ(refusal(lamp_scene(GetParam(), {90, 90})), "size");
    EXPECT_EQ(refusal(lamp_scene(GetParam()), {{"file scene.pbrt", "2"}}), "file scene.pbrt");
    EXPECT_EQ(refusal(lamp_scene(GetParam()), {}), "file scene.pbrt");
    RenderSettings other = GetParam();
    other.seed = 5;
    EXPECT_EQ(refusal(lamp_scene(other)), "seed");
    other = GetParam();
    other.max_depth = 4;
    EXPECT_EQ(refusal(lamp_scene(other)), "depth");
    other = GetParam();
    other.error > 0 ? other.error = 0.05 : other.samples = 80;
    EXPECT_EQ(refusal(lamp_scene(other)), other.error > 0 ? "error" : "samples");
    other = GetParam();
    other.error = other.error > 0 ? 0 : 0.1; // one sort of run for the other
    EXPECT_EQ(refusal(lamp_scene(other)), other.error > 0 ? "error" : "samples");
}

TEST_P(RenderCheckpointed, DamagedOnesAreRefused) {
    Image image;
    ASSERT_FALSE(run(50, lamp_scene(GetParam()), image));
    const std::string bytes = tests::read_bytes(part_);
    const Scene scene = lamp_scene(GetParam());
    for (const size_t length : {size_t{0}, size_t{20}, bytes.size() / 2, bytes.size() - 1}) {
        tests::write_bytes(part_, bytes.substr(0, length));
        EXPECT_THROW(run(1, scene, image), FileError) << length;
    }
    TensorFile file;
    const auto damaged = [&](const std::string& name, const auto& value) {
        tests::write_bytes(part_, bytes);
        file = read_tensor_file(part_);
        std::memcpy(file[name].bytes.data() + sizeof value, &value, sizeof value);
        write_tensor_file(file, part_);
        return refusal(scene);
    };
    EXPECT_EQ(damaged("samples", int{-1}), "samples[1]");
    EXPECT_EQ(damaged("samples", int{1 << 30}), "samples[1]");
    EXPECT_EQ(damaged("sums", std::numeric_limits<double>::quiet_NaN()), "sums[1]");
}

INSTANTIATE_TEST_SUITE_P(To, RenderCheckpointed, testing::Values(to_samples(), to_error()),
                         [](const auto& info) { return info.index == 0 ? "Samples" : "Error"; });

TEST(InputLog, TellsFilesByNameAndBytes) {
    const tests::TemporaryFolder folder, elsewhere;
    const auto hashes = [](const std::filesystem::path& path, const std::string& bytes) {
        tests::write_bytes(path, bytes);
        const InputLog log(InputLog::Of::bytes);
        InputFile file = open_input(path);
        EXPECT_EQ(std::string(std::istreambuf_iterator<char>(file.stream), {}), bytes);
        return log.hashes();
    };
    const std::string large(200'003, 'x');
    const auto first = hashes(folder / "a", large);
    EXPECT_EQ(hashes(elsewhere / "a", large), first);
    EXPECT_NE(hashes(folder / "b", large), first);
    for (const size_t place : {size_t{0}, size_t{65'535}, size_t{65'536}, size_t{200'002}}) {
        std::string other = large;
        other[place] ^= 1;
        EXPECT_NE(hashes(folder / "a", other), first) << place;
    }
    EXPECT_NE(hashes(folder / "a", large + '\0'), first);
    EXPECT_NE(hashes(folder / "a", ""), hashes(folder / "a", std::string(1, '\0')));
}

TEST(InputLog, OfNamesTellsAlsoWhatIsMissingAndWhatAnInnerOneSaw) {
    const tests::TemporaryFolder folder;
    tests::write_bytes(folder / "a", "a");
    const auto canonical = [&](const char* name) {
        return std::filesystem::weakly_canonical(folder / name);
    };
    using Files = std::set<std::filesystem::path>;
    const InputLog log(InputLog::Of::names);
    {
        const InputLog inner(InputLog::Of::bytes);
        open_input(folder / "a");
        EXPECT_EQ(inner.files(), Files{canonical("a")});
        EXPECT_EQ(inner.hashes().size(), 1u);
    }
    EXPECT_THROW(open_input(folder / "absent"), FileError);
    EXPECT_EQ(log.files(), (Files{canonical("a"), canonical("absent")}));
    EXPECT_TRUE(log.hashes().empty());
}

TEST(Command, AKilledPictureIsResumedToTheSamePixels) {
    const tests::TemporaryFolder folder;
    const std::string whole = (folder / "whole.exr").string();
    const std::string killed = (folder / "killed.exr").string();
    const auto rendered = [&](const std::string& output, const std::string& threads,
                              unsigned killed_after) {
        return tests::run_and_kill_program(
            {"render", RAPPORT_SOURCE_DIR "/scenes/garments/dress.glb", "--size", "64x64", "--spp",
             "2000", "--threads", threads, "--resume", "-o", output},
            killed_after);
    };
    const auto start = std::chrono::steady_clock::now();
    rendered(whole, "2", 0);
    const std::chrono::duration<double, std::micro> took = std::chrono::steady_clock::now() - start;
    int kills = 0;
    CounterRng rng(static_cast<uint64_t>(getpid()), Purpose::test, 0, 0);
    for (int i = 0; i < 3; ++i)
        kills += rendered(killed, std::to_string(1 + i),
                          static_cast<unsigned>(took.count() * (0.3 + 0.3 * rng.uniform())));
    rendered(killed, "2", 0);
    EXPECT_EQ(read_exr(killed).data, read_exr(whole).data);
    EXPECT_FALSE(std::filesystem::exists(killed + ".part"));
    EXPECT_GT(kills, 0);
}

} // namespace
} // namespace rapport
