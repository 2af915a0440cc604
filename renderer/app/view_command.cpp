#include "renderer/app/measuring_line.h"
#include "renderer/app/scene_options.h"
#include "renderer/core/input_file.h"
#include "renderer/preview/view.h"

#include <fmt/format.h>
#include <memory>

namespace rapport {
namespace {

struct ViewOptions : SceneOptions {
    int frames = 0;
    std::string screenshot;
};

void run(const ViewOptions& options, const CommonOptions& common) {
    constexpr glm::ivec2 kWindowSize{1280, 800};
    const glm::ivec2 size = options.resolution(kWindowSize);
    if (!options.screenshot.empty() && lower_extension(options.screenshot) != ".png")
        throw FileError("command line", "--screenshot", "a file that ends in .png",
                        options.screenshot);
    MeasuringLine line(common);
    Session session(
        {options.scene, options.cloth_of_material(), options.colourway_of_material(), common.seed},
        [&](const std::filesystem::path& cloth, const GoniophotometerProgress& progress) {
            line.update(cloth, progress);
        });
    line.end();
    const std::vector<std::string> notes =
        view(session, size, {options.frames, options.screenshot});
    if (!common.quiet)
        for (const std::string& note : notes)
            fmt::print(stderr, "{}\n", note);
}

} // namespace

void add_view_command(CLI::App& app, const CommonOptions& common) {
    const auto options = std::make_shared<ViewOptions>();
    CLI::App* command =
        app.add_subcommand("view", "Look at a scene, or a model in a cloth, and edit the cloth");
    options->add_to(*command);
    CLI::Option* const frames =
        command->add_option("--frames", options->frames, "Close after so many frames of the window")
            ->check(CLI::Range(1, 1 << 24));
    command->add_option("--screenshot", options->screenshot, "PNG of the last of these frames")
        ->needs(frames);
    command->callback([options, &common] { run(*options, common); });
}

} // namespace rapport
