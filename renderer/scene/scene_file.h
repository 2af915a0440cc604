#pragma once

#include "renderer/scene/scene_description.h"

namespace rapport {

/// A `.pbrt` scene, or a bare `.gltf` or `.glb` model with a camera of `model_resolution` and light
/// around it (model_scene.h). FileError for another ending.
SceneDescription read_scene(const std::filesystem::path& path, const glm::ivec2& model_resolution);

} // namespace rapport
