#include "renderer/scene/scene_file.h"

#include "renderer/core/error.h"
#include "renderer/core/input_file.h"
#include "renderer/scene/model_scene.h"
#include "renderer/scene/pbrt/pbrt_parser.h"

namespace rapport {

SceneDescription read_scene(const std::filesystem::path& path, const glm::ivec2& model_resolution) {
    const std::string extension = lower_extension(path);
    if (extension == ".gltf" || extension == ".glb")
        return describe_model(path, model_resolution);
    if (extension == ".pbrt")
        return parse_pbrt(path);
    throw FileError(path.string(), "", "a scene (.pbrt) or model (.gltf, .glb)", "another ending");
}

} // namespace rapport
