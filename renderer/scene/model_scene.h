#pragma once

#include "renderer/scene/scene_description.h"

namespace rapport {

/// A scene around a bare glTF model: the whole of it framed from the front, a little to its left
/// and from above (glTF: +y up, front towards +z), under a soft sky and a large lamp behind the
/// camera's left shoulder. Parts without a cloth wear
/// the base colour of their file.
SceneDescription describe_model(const std::filesystem::path& model, const glm::ivec2& resolution);

} // namespace rapport
