#include "renderer/app/measuring_line.h"
#include "renderer/app/scene_options.h"
#include "renderer/core/input_file.h"
#include "renderer/core/progress.h"
#include "renderer/integrator/path_tracer.h"
#include "renderer/integrator/streaks.h"
#include "renderer/scene/scene_builder.h"
#include "renderer/scene/scene_file.h"
#include "renderer/scene/table_loader.h"

#include <algorithm>
#include <chrono>
#include <csignal>
#include <fmt/format.h>
#include <iostream>
#include <memory>
#include <optional>

namespace rapport {
namespace {

struct RenderOptions : SceneOptions {
    std::vector<std::string> outputs;
    int samples = 0;  ///< 0 = as the scene says
    double error = 0; ///< 0 = none is asked for
    std::string aov;  ///< drawn instead of the picture
    double accuracy = 0.2;
};

SceneDescription describe(const RenderOptions& options, const CommonOptions& common) {
    constexpr glm::ivec2 kModelSize{1024, 1024};
    SceneDescription description = read_scene(options.scene, options.resolution(kModelSize));
    description.camera.resolution = options.resolution(description.camera.resolution);
    if (options.samples > 0)
        description.settings.samples = options.samples;
    description.settings.error = options.error;
    description.settings.seed = common.seed;
    return description;
}

/// The files to write; their endings are checked before any work is done.
std::vector<std::filesystem::path> outputs(const RenderOptions& options,
                                           const std::string& of_scene) {
    std::vector<std::filesystem::path> paths(options.outputs.begin(), options.outputs.end());
    if (paths.empty())
        paths.push_back(
            of_scene.empty()
                ? std::filesystem::path(options.scene).filename().replace_extension(".exr")
                : std::filesystem::path(of_scene));
    for (const std::filesystem::path& path : paths)
        if (lower_extension(path) != ".exr" && lower_extension(path) != ".png")
            throw FileError(path.string(), "", "an output that ends in .exr or .png",
                            "another ending");
    return paths;
}

Scene load(const RenderOptions& options, const CommonOptions& common,
           const SceneDescription& description) {
    MeasuringLine line(common);
    TableLoader tables(
        options.accuracy, common.seed,
        [&](const std::filesystem::path& path, const GoniophotometerProgress& progress) {
            line.update(path, progress);
        });
    std::vector<std::string> warnings;
    BuildOptions build{options.cloth_of_material(),
                       [&](const std::filesystem::path& path, const std::string& colourway) {
                           return tables.load(path, colourway);
                       },
                       options.colourway_of_material()};
    Scene scene = build_scene(description, build, warnings);
    line.end();
    if (common.quiet)
        return scene;
    for (const std::string& warning : warnings)
        fmt::print(stderr, "warning: {}\n", warning);
    for (const auto& [path, table] : tables.measured())
        fmt::print("{}: measured to accuracy {:.4f} on {} bins\n", path.string(),
                   table->largest_accuracy(), 2 * table->exits.bins());
    return scene;
}

volatile std::sig_atomic_t interrupted = 0;

/// Renders; Ctrl-C ends it with the samples that there are.
Film render_watched(const Scene& scene, const CommonOptions& common) {
    std::optional<ProgressLine> line;
    if (shows_progress(common))
        line.emplace(std::cerr, "rendering");
    std::signal(SIGINT, [](int) { interrupted = 1; });
    RenderWatcher watcher;
    const auto start = std::chrono::steady_clock::now();
    const double pixels =
        static_cast<double>(scene.camera.resolution.x) * scene.camera.resolution.y;
    watcher.progress = [&](double fraction, double samples) {
        const double seconds =
            std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
        if (line)
            line->update(fraction, fmt::format("{:.4g} samples, {:.2f} M paths/s", samples,
                                               1e-6 * samples * pixels / std::max(seconds, 1e-6)));
    };
    watcher.stopped = [] { return interrupted != 0; };
    Film film = render(scene, watcher);
    std::signal(SIGINT, SIG_DFL);
    return film;
}

void run(const RenderOptions& options, const CommonOptions& common) {
    const SceneDescription description = describe(options, common);
    const std::vector<std::filesystem::path> paths = outputs(options, description.settings.output);
    const Scene scene = load(options, common, description);

    const auto start = std::chrono::steady_clock::now();
    const Film film = render_watched(scene, common);
    const double seconds =
        std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    const std::string samples = fmt::format("{:.4g}", film.mean_samples());
    const std::string noise = fmt::format("{:.4g}", film.noise().relative());

    std::string command = "rapport render " + options.scene;
    for (const std::string& cloth : options.cloths)
        command += " --cloth " + cloth;
    for (const std::string& colourway : options.colourways)
        command += " --colourway " + colourway;
    Image image = film.image();
    if (options.aov == "warp")
        image = warp_streaks(image, scene.camera);
    image.attributes["command"] = command;
    image.attributes["seed"] = std::to_string(common.seed);
    image.attributes["samples"] = samples;
    image.attributes["noise"] = noise;
    image.attributes["seconds"] = fmt::format("{:.3f}", seconds);
    for (const std::filesystem::path& path : paths) {
        if (lower_extension(path) == ".exr")
            write_exr(image, path);
        else
            write_png(image, path);
        if (!common.quiet)
            fmt::print("{}: {} x {}, {} samples a pixel, relative noise {}, {:.1f} s{}\n",
                       path.string(), image.width, image.height, samples, noise, seconds,
                       interrupted ? ", interrupted" : "");
    }
}

} // namespace

void add_render_command(CLI::App& app, const CommonOptions& common) {
    const auto options = std::make_shared<RenderOptions>();
    CLI::App* command = app.add_subcommand("render", "Render a scene, or a model in a cloth");
    options->add_to(*command);
    command->add_option("-o,--output", options->outputs,
                        "Image to write, .exr or .png (repeatable; default: as the scene says)");
    CLI::Option* const samples = command->add_option("--spp", options->samples, "Samples per pixel")
                                     ->check(CLI::Range(1, 1 << 24));
    command
        ->add_option("--error", options->error,
                     "Relative noise to reach in the picture and in 95 % of its tiles")
        ->check(CLI::Range(1e-4, 1.0))
        ->excludes(samples);
    command
        ->add_option("--aov", options->aov,
                     "Draws something else instead: warp, streaks along the warp threads")
        ->check(CLI::IsMember({"warp"}));
    command
        ->add_option("--accuracy", options->accuracy,
                     "Accuracy of a cloth that is measured on the way (default 0.2)")
        ->check(CLI::PositiveNumber);
    command->callback([options, &common] { run(*options, common); });
}

} // namespace rapport
