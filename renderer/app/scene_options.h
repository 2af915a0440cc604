#pragma once

#include "renderer/app/commands.h"
#include "renderer/core/error.h"

#include <glm/glm.hpp>
#include <map>
#include <string>
#include <vector>

namespace rapport {

/// What commands that show a scene take of the command line.
struct SceneOptions {
    std::string scene, size;
    std::vector<std::string> cloths, colourways;

    /// Adds the options to a command.
    void add_to(CLI::App& command);
    /// `size`; FileError if it is no size, `fallback` if there is none.
    glm::ivec2 resolution(const glm::ivec2& fallback) const;
    std::map<std::string, std::filesystem::path> cloth_of_material() const;
    std::map<std::string, std::string> colourway_of_material() const;
};

} // namespace rapport
