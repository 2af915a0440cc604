#include "renderer/app/measuring_line.h"
#include "renderer/app/scene_options.h"
#include "renderer/core/atomic_file.h"
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
    bool resume = false;
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
    std::ranges::for_each(paths, check_writable);
    return paths;
}

Scene load(const RenderOptions& options, const SceneDescription& description, TableLoader& tables,
           std::vector<std::string>& warnings) {
    BuildOptions build{options.cloth_of_material(),
                       [&](const std::filesystem::path& path, const std::string& colourway) {
                           return tables.load(path, colourway);
                       },
                       options.colourway_of_material()};
    return build_scene(description, build, warnings);
}

/// What the scene was made of, for its checkpoint.
std::map<std::string, std::string> made_of(const RenderOptions& options, const InputLog& files,
                                           const TableLoader& tables) {
    std::map<std::string, std::string> parts;
    for (const auto& [name, hashes] : files.hashes())
        parts["file " + name] = hashes;
    for (const auto& [material, cloth] : options.cloth_of_material())
        parts["cloth " + material] = cloth.filename().string();
    for (const auto& [material, colourway] : options.colourway_of_material())
        parts["colourway " + material] = colourway;
    for (const auto& [key, loaded] : tables.tables())
        if (lower_extension(loaded.path) != ".bsdf")
            parts["accuracy"] = fmt::format("{}", options.accuracy);
    return parts;
}

volatile std::sig_atomic_t interrupted = 0;

/// Renders; Ctrl-C ends it with the samples that there are.
Film render_watched(const Scene& scene, const CommonOptions& common,
                    const RenderCheckpoint& checkpoint) {
    std::optional<ProgressLine> line;
    if (shows_progress(common))
        line.emplace(std::cerr, "rendering");
    std::signal(SIGINT, [](int) {
        interrupted = 1;
        std::signal(SIGINT, SIG_DFL); // a second one does not wait for the samples in hand
    });
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
    Film film = render(scene, watcher, checkpoint);
    std::signal(SIGINT, SIG_DFL);
    return film;
}

/// The errors of the measured tables, which no sample of the picture can tell of.
std::string table_errors(const TableLoader& tables) {
    std::string text;
    for (const auto& [key, loaded] : tables.tables()) {
        const BsdfTable& table = loaded.table->table();
        const std::string colourway = key.second.empty() ? "" : " in " + key.second;
        text += fmt::format("{}{}: accuracy {:.4f} on {} bins, which is not in that noise\n",
                            loaded.path.string(), colourway, table.largest_accuracy(),
                            2 * table.exits.bins());
    }
    return text;
}

/// The film's image, or what is drawn instead of it, and how it came about.
Image described_image(const Film& film, const Scene& scene, const RenderOptions& options,
                      const CommonOptions& common) {
    Image image = film.image();
    if (options.aov == "warp")
        image = warp_streaks(image, scene.camera);
    std::string command = "rapport render " + options.scene;
    for (const std::string& cloth : options.cloths)
        command += " --cloth " + cloth;
    for (const std::string& colourway : options.colourways)
        command += " --colourway " + colourway;
    image.attributes["command"] = command;
    image.attributes["seed"] = std::to_string(common.seed);
    image.attributes["samples"] = fmt::format("{:.4g}", film.mean_samples());
    image.attributes["cut"] = fmt::format("{:.4g}", film.cut_share());
    image.attributes["noise"] = fmt::format("{:.4g}", film.noise().relative());
    return image;
}

void run(const RenderOptions& options, const CommonOptions& common) {
    InputLog files(InputLog::Of::bytes);
    const SceneDescription description = describe(options, common);
    const std::vector<std::filesystem::path> paths = outputs(options, description.settings.output);
    MeasuringLine line(common);
    TableLoader tables(
        options.accuracy, common.seed,
        [&](const std::filesystem::path& path, const GoniophotometerProgress& progress) {
            line.update(path, progress);
        });
    std::vector<std::string> warnings;
    const Scene scene = load(options, description, tables, warnings);
    line.end();
    if (!common.quiet)
        for (const std::string& warning : warnings)
            fmt::print(stderr, "warning: {}\n", warning);
    RenderCheckpoint checkpoint{{paths[0], options.resume}, made_of(options, files, tables)};
    checkpoint.path += ".part";
    if (options.resume && !common.quiet && !std::filesystem::exists(checkpoint.path))
        fmt::print(stderr, "{}: not there, so the picture starts from the beginning\n",
                   checkpoint.path.string());

    const auto start = std::chrono::steady_clock::now();
    const Film film = render_watched(scene, common, checkpoint);
    const double seconds =
        std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    Image image = described_image(film, scene, options, common);
    image.attributes["seconds"] = fmt::format("{:.3f}", seconds);
    if (const std::string errors = table_errors(tables); !errors.empty())
        image.attributes["tables"] = errors;
    for (const std::filesystem::path& path : paths) {
        if (lower_extension(path) == ".exr")
            write_exr(image, path);
        else
            write_png(image, path);
        if (!common.quiet)
            fmt::print("{}: {} x {}, {} samples a pixel, relative noise {}, {:.1f} s{}\n",
                       path.string(), image.width, image.height, image.attributes["samples"],
                       image.attributes["noise"], seconds,
                       interrupted ? ", interrupted; --resume goes on" : "");
    }
    if (!common.quiet) {
        fmt::print("{}", table_errors(tables));
        if (const double cut = film.cut_share(); cut > 0)
            fmt::print("maxdepth {}: {:.2g} % of the scattering was cut off\n",
                       scene.settings.max_depth, 100 * cut);
    }
    if (!interrupted)
        std::filesystem::remove(checkpoint.path);
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
        ->check(finite_number(1e-4, 1.0))
        ->excludes(samples);
    command
        ->add_option("--aov", options->aov,
                     "Draws something else instead: warp, streaks along the warp threads")
        ->check(CLI::IsMember({"warp"}));
    command
        ->add_option("--accuracy", options->accuracy,
                     "Accuracy of a cloth that is measured on the way (default 0.2)")
        ->check(positive_number());
    command->add_flag("--resume", options->resume,
                      "Go on with a picture that was interrupted, from OUTPUT.part");
    command->callback([options, &common] { run(*options, common); });
}

} // namespace rapport
