#pragma once

#include "renderer/scene/camera.h"

#include <filesystem>

namespace rapport {

/// Writes a copy of the scene file `scene` (.pbrt) to `copy`, in which the camera stands where
/// `camera` does: a Transform before its Camera directive takes the place of all before it.
/// FileError where the directive is not in this file. The copy names other files as the scene does,
/// so it should lie in the same folder.
void save_camera(const Camera& camera, const std::filesystem::path& scene,
                 const std::filesystem::path& copy);

} // namespace rapport
