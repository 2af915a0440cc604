#pragma once

#include "materials/bsdf.h"
#include "renderer/scene/scene.h"
#include "renderer/scene/scene_description.h"

#include <filesystem>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace rapport {

struct BuildOptions {
    /// Named material, of the scene or of a glTF model, → the cloth (.bsdf, .toml, .wif) that
    /// replaces it; the empty name stands for every glTF material that is not listed. One
    /// that no shape wears is a FileError.
    std::map<std::string, std::filesystem::path> cloths;
    /// How materials get their tables; see TableLoader.
    LoadTable load_table;
    /// By the same names, the colourways of those cloths; a name without a cloth is a FileError.
    std::map<std::string, std::string> colourways{};
    /// From where surfaces are seen that are cut as finely as that needs; by default the
    /// description's own.
    std::optional<Camera> seen_from = std::nullopt;
};

/// Reads everything that a description names and makes the scene. What was ignored or mended on
/// the way is appended to `warnings`, a line each.
Scene build_scene(const SceneDescription& description, const BuildOptions& options,
                  std::vector<std::string>& warnings);

} // namespace rapport
