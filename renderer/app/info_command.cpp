#include "renderer/app/commands.h"
#include "renderer/app/info.h"
#include "renderer/app/info_picture.h"
#include "renderer/core/error.h"
#include "renderer/core/input_file.h"

#include <fmt/format.h>
#include <functional>
#include <map>
#include <memory>

namespace rapport {
namespace {

struct InfoOptions {
    std::string file, picture;
    bool json = false;
};

Info info(const std::filesystem::path& path) {
    static const std::map<std::string, std::function<Info(const std::filesystem::path&)>> readers{
        {".wif", draft_info},  {".toml", cloth_info}, {".bsdf", table_info}, {".exr", image_info},
        {".gltf", model_info}, {".glb", model_info},  {".pbrt", scene_info}};
    const auto reader = readers.find(lower_extension(path));
    if (reader == readers.end())
        throw FileError(path.string(), "", "a .wif, .toml, .bsdf, .exr, .gltf, .glb or .pbrt file",
                        "another ending");
    return reader->second(path);
}

} // namespace

void add_info_command(CLI::App& app) {
    const auto options = std::make_shared<InfoOptions>();
    CLI::App* command = app.add_subcommand("info", "Say what is in a file");
    command->add_option("file", options->file, "Draft, cloth, table, image, model or scene")
        ->required();
    command->add_flag("--json", options->json, "For programs");
    command->add_option("--picture", options->picture,
                        "PNG or SVG to draw: a draft's drawdown, a cloth's fibres, where a table "
                        "sends light and its errors, a model's warp");
    command->callback([options] {
        if (!options->picture.empty())
            return draw_picture(options->file, options->picture);
        const Info found = info(options->file);
        if (options->json)
            fmt::print("{}\n", found.json.dump(2));
        else
            fmt::print("{}", found.text);
    });
}

} // namespace rapport
