#pragma once

#include "renderer/scene/mesh.h"

#include <filesystem>

namespace rapport {

struct GltfPart {
    std::string name;     ///< of the mesh, with the primitive's number where there are several
    std::string material; ///< name of the glTF material, or empty
    IndexedMesh mesh;     ///< node transforms applied (metres, glTF's axes)
};

struct GltfModel {
    std::vector<GltfPart> parts;
    std::vector<std::string> warnings; ///< what was ignored or mended, one line each
};

/// Reads the static geometry of a `.gltf` or `.glb`. Everything is bounds-checked; positions are
/// welded by value; v ← 1 − v here and nowhere else. FileError names what is damaged, missing or,
/// like Draco and meshopt compression, not supported.
GltfModel read_gltf(const std::filesystem::path& path);

} // namespace rapport
