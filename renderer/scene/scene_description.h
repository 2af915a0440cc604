#pragma once

#include "renderer/core/params.h"
#include "renderer/scene/camera.h"
#include "renderer/scene/render_settings.h"

#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

// A scene as it was written down, before any mesh, image or table is read: plain data, to be
// changed freely (size, samples, seed) before `build_scene`.

namespace rapport {

struct GltfModel;

struct TextureDescription {
    Params params;                  ///< of an "imagemap"
    std::filesystem::path base_dir; ///< file names are relative to it
};

struct MaterialDescription {
    std::string type = "diffuse";
    Params params;
    std::filesystem::path base_dir; ///< file names are relative to it
    std::string name;               ///< of a named material, else empty
    /// A diffuse material's reflectance where that is a texture.
    std::shared_ptr<const TextureDescription> reflectance;
};

struct LightDescription {
    std::string type;
    Params params;
    glm::mat4 to_world{1};
};

struct ShapeDescription {
    std::string type;
    Params params;
    glm::mat4 to_world{1};
    bool reverse_orientation = false;
    /// Shared by the shapes that wear it. Null where the scene states none: parts of a glTF model
    /// then wear the base colour of their file, everything else pbrt's default, a grey diffuse.
    std::shared_ptr<const MaterialDescription> material;
    std::optional<Params> area_light; ///< of `AreaLightSource "diffuse"`
    /// Of a "gltf" shape, what its file holds, if it was read already.
    std::shared_ptr<const GltfModel> model = nullptr;
};

struct SceneDescription {
    std::filesystem::path path; ///< the file it stands in; file names are relative to its folder
    Camera camera;
    RenderSettings settings;
    std::vector<LightDescription> lights;
    std::vector<ShapeDescription> shapes;
    std::map<std::string, std::shared_ptr<const MaterialDescription>> named_materials;
    /// What the file states, whether anything uses it or not: mistakes are told there too.
    struct {
        std::vector<std::shared_ptr<const MaterialDescription>> materials;
        std::vector<std::shared_ptr<const TextureDescription>> textures;
        std::vector<Params> area_lights;
        std::vector<ShapeDescription> unplaced_shapes; ///< of objects without an instance
    } stated;
};

} // namespace rapport
