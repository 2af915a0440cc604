#include "renderer/app/scene_options.h"

#include <cstdio>
#include <fmt/format.h>

namespace rapport {
namespace {

/// "CHOICE" or "MATERIAL=CHOICE", by material.
template <class Choice>
std::map<std::string, Choice> parse_choices(const std::vector<std::string>& texts,
                                            const char* option, const char* expected) {
    std::map<std::string, Choice> choices;
    for (const std::string& text : texts) {
        const size_t equals = text.find('=');
        const std::string material = equals == std::string::npos ? "" : text.substr(0, equals);
        const std::string choice = equals == std::string::npos ? text : text.substr(equals + 1);
        if (choice.empty() || !choices.emplace(material, choice).second)
            throw FileError("command line", option, expected, text);
    }
    return choices;
}

} // namespace

void SceneOptions::add_to(CLI::App& command) {
    command.add_option("scene", scene, "Scene .pbrt, or model .gltf or .glb")->required();
    command.add_option("--cloth", cloths,
                       "Cloth (.bsdf, .toml or .wif) for every glTF material, or as "
                       "MATERIAL=CLOTH for one (repeatable)");
    command.add_option("--colourway", colourways,
                       "Colourway of the cloth given for every glTF material, or as "
                       "MATERIAL=COLOURWAY for one (repeatable)");
    command.add_option("--size", size, "WIDTHxHEIGHT in pixels");
}

glm::ivec2 SceneOptions::resolution(const glm::ivec2& fallback) const {
    constexpr int kLargest = 32768;
    if (size.empty())
        return fallback;
    int width = 0, height = 0, used = 0;
    if (std::sscanf(size.c_str(), "%6dx%6d%n", &width, &height, &used) != 2 ||
        used != static_cast<int>(size.size()) || width < 1 || height < 1 || width > kLargest ||
        height > kLargest)
        throw FileError("command line", "--size",
                        fmt::format("WIDTHxHEIGHT, each 1 to {}", kLargest), size);
    return {width, height};
}

std::map<std::string, std::filesystem::path> SceneOptions::cloth_of_material() const {
    return parse_choices<std::filesystem::path>(cloths, "--cloth", "one cloth file per material");
}

std::map<std::string, std::string> SceneOptions::colourway_of_material() const {
    return parse_choices<std::string>(colourways, "--colourway", "one colourway per material");
}

} // namespace rapport
