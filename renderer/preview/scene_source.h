#pragma once

#include "renderer/preview/cloth_worker.h"
#include "renderer/scene/scene.h"

#include <map>

namespace rapport {

/// Where a scene comes from.
struct SceneSource {
    std::filesystem::path path;                            ///< .pbrt, .gltf or .glb
    std::map<std::string, std::filesystem::path> cloths{}; ///< as BuildOptions::cloths
    std::map<std::string, std::string> colourways{};       ///< as BuildOptions::colourways
    uint64_t seed = 0;
    std::optional<Camera> seen_from{}; ///< as BuildOptions::seen_from
};

using ClothTables = std::map<std::filesystem::path, std::shared_ptr<const ClothTable>>;

struct LoadedScene {
    std::shared_ptr<const Scene> scene;
    ClothTables tables; ///< of all cloths in it, by canonical path
    std::vector<std::string> warnings;
};

/// Told while the cloth `file` is being measured.
using LoadingWatch =
    std::function<void(const std::filesystem::path& file, const GoniophotometerProgress&)>;

/// Reads the scene and all that it names. Tables in `known` are taken as they are; other cloths are
/// read, or measured in haste. FileError as from what is read; Stopped while one is measured.
LoadedScene load_scene(const SceneSource& source, const ClothTables& known = {},
                       const LoadingWatch& watch = {}, const StopSignal& stopped = {});

/// The table that a material asks for. FileError for a colourway that the cloth has not.
std::shared_ptr<const TableBsdf> in_colourway(const ClothTable& table,
                                              const std::filesystem::path& file,
                                              const std::string& colourway);

} // namespace rapport
