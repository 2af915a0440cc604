#include "renderer/core/math.h"
#include "renderer/integrator/path_tracer.h"
#include "renderer/scene/scene_builder.h"
#include "renderer/scene/scene_file.h"
#include "tests/bench/fitted_sampler.h"
#include "tests/support/small_scenes.h"
#include "tests/support/temporary_folder.h"

#include <cstdio>
#include <ctime>
#include <glm/gtc/matrix_transform.hpp>

// What sampling from the table buys over sampling from lobes that are fitted to it: lines of scene,
// cloth, sky, sampler, samples a pixel, seconds of processor time, and the mean and the variance
// of the pixels' means, of a scene under a sky, over the pixels that it
// fills: what is seen of the sky itself is as noisy with either. Runs of the two samplers
// alternate, each with random numbers of its own. charts/sampling.py draws them:
//
//   build/tests/tests/sampling_bench scenes/garments/dress.glb ../shared/bench/sheet.pbrt
//       TABLE.bsdf... SKY.exr... | python3 tests/bench/charts/sampling.py
//
// Scenes are models, of which the part named Body wears the cloth, or .pbrt files with +z up, all
// of which does. The skies are latitude–longitude pictures in linear RGB.

namespace rapport {
namespace {

constexpr int kRounds = 3;
constexpr const char* kCloth = "Body";
constexpr glm::ivec2 kPicture{96, 96};

/// A copy without the negative values that compression leaves in pictures, which lights refuse.
std::filesystem::path without_negatives(const std::filesystem::path& sky,
                                        const tests::TemporaryFolder& folder) {
    Image image = read_exr(sky);
    for (const char* channel : {"R", "G", "B"})
        for (float& value : *image.find(channel))
            value = std::max(value, 0.0f);
    write_exr(image, folder / "sky.exr");
    return folder / "sky.exr";
}

bool is_model(const std::filesystem::path& scene) { return scene.extension() == ".glb"; }

SceneDescription under_sky(const std::filesystem::path& path, const std::filesystem::path& sky) {
    SceneDescription scene = read_scene(path, kPicture);
    scene.camera.resolution = kPicture;
    if (is_model(path))
        scene.shapes.erase(scene.shapes.begin()); // the lamp
    Param filename;
    filename.type = "string";
    filename.name = "filename";
    filename.strings = {std::filesystem::absolute(sky).string()};
    Params params("sampling_bench", "the sky", 0);
    params.add(filename);
    // Skies are +z up, models +y.
    scene.lights = {{"infinite", params,
                     is_model(path) ? glm::rotate(glm::mat4(1), radians(-90.0f), glm::vec3(1, 0, 0))
                                    : glm::mat4(1)}};
    return scene;
}

Scene worn(const Scene& scene, bool whole, const std::shared_ptr<const Bsdf>& material) {
    std::vector<Surface> surfaces = scene.surfaces();
    for (Surface& surface : surfaces)
        if (whole || (surface.description && surface.description->name == kCloth))
            surface.material = material;
    return {scene, std::move(surfaces), scene.lights()};
}

struct Noise {
    double mean = 0;     ///< of the pixels' means
    double variance = 0; ///< of a pixel's mean
};

/// In the mean over channels and the pixels that are filled, from what two pictures differ by:
/// that knows what evenly spread samples gain.
Noise noise_of_model(const Image& one, const Image& other) {
    constexpr float kFilled = 0.9f; // length of the mean of unit normals, 0 where there is sky
    const auto plane = [&](const std::string& name) -> const std::vector<float>& {
        return *one.find(name);
    };
    Noise noise;
    size_t values = 0;
    for (size_t i = 0; i < plane("R").size(); ++i) {
        const glm::vec3 normal(plane("N.X")[i], plane("N.Y")[i], plane("N.Z")[i]);
        if (glm::length(normal) < kFilled)
            continue;
        for (const std::string channel : {"R", "G", "B"}) {
            const double a = plane(channel)[i], b = (*other.find(channel))[i];
            noise.mean += 0.5 * (a + b);
            noise.variance += 0.5 * square(a - b);
            ++values;
        }
    }
    return {noise.mean / double(values), noise.variance / double(values)};
}

void compare_samplers(const std::filesystem::path& path, const std::filesystem::path& cloth,
                      const std::filesystem::path& sky) {
    const auto table =
        std::make_shared<const TableBsdf>(read_table(cloth), cloth.filename().string());
    BuildOptions options;
    if (is_model(path))
        options.cloths[kCloth] = cloth;
    options.load_table = [&](const auto&, const auto&) { return table; };
    std::vector<std::string> warnings;
    const tests::TemporaryFolder folder;
    const Scene built =
        build_scene(under_sky(path, without_negatives(sky, folder)), options, warnings);
    const auto by_table = tests::cloth_of(table);
    const auto by_lobes = std::make_shared<const tests::FittedSampler>(by_table);
    std::fprintf(stderr, "%s: %s\n", cloth.filename().c_str(), by_lobes->describe().c_str());

    uint64_t seed = 0;
    for (const int samples : {4, 16, 64})
        for (int round = 0; round < kRounds; ++round)
            for (const auto& [name, material] :
                 {std::pair<const char*, std::shared_ptr<const Bsdf>>("table", by_table),
                  {"lobes", by_lobes}}) {
                Scene scene = worn(built, !is_model(path), material);
                scene.settings.samples = samples;
                const auto rendered = [&] {
                    scene.settings.seed = ++seed;
                    return render(scene).image();
                };
                const std::clock_t start = std::clock();
                const Image one = rendered(), other = rendered();
                const double seconds = double(std::clock() - start) / CLOCKS_PER_SEC / 2;
                const Noise noise = noise_of_model(one, other);
                std::printf("%s,%s,%s,%s,%d,%.4f,%.6g,%.6g\n", path.stem().c_str(),
                            cloth.stem().c_str(), sky.stem().c_str(), name, samples, seconds,
                            noise.mean, noise.variance);
                std::fflush(stdout);
            }
}

} // namespace
} // namespace rapport

int main(int count, char** arguments) {
    if (count < 4) {
        std::fputs("usage: sampling_bench SCENE.glb|pbrt... TABLE.bsdf... SKY.exr...\n", stderr);
        return 2;
    }
    std::vector<std::filesystem::path> scenes, tables, skies;
    for (int i = 1; i < count; ++i) {
        const std::filesystem::path file = arguments[i];
        if (!std::filesystem::exists(file)) { // skies are no part of the checkout
            std::fprintf(stderr, "%s: not there, left out\n", file.c_str());
            continue;
        }
        (file.extension() == ".exr"    ? skies
         : file.extension() == ".bsdf" ? tables
                                       : scenes)
            .push_back(file);
    }
    std::puts("scene,cloth,sky,sampler,samples,seconds,mean,variance");
    for (const auto& scene : scenes)
        for (const auto& table : tables)
            for (const auto& sky : skies)
                rapport::compare_samplers(scene, table, sky);
}
