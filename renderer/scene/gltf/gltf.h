#pragma once

#include "renderer/scene/mesh/mesh_cleaning.h"
#include "renderer/scene/picture.h"

#include <filesystem>

namespace rapport {

struct GltfPart {
    std::string name;     ///< of the mesh, with the primitive's number where there are several
    std::string material; ///< name of the glTF material, or empty
    CleanMesh mesh;       ///< node transforms applied (metres, glTF's axes)
    BaseColor base_color;
};

struct GltfModel {
    std::vector<GltfPart> parts;
    std::vector<std::string> warnings; ///< what was ignored or mended, one line each
};

/// Reads the geometry of a `.gltf` or `.glb` as it stands when nothing is animated: morph targets
/// at the weights that node or mesh give, skinned meshes where their joints are. Everything is
/// bounds-checked; v ← 1 − v here and nowhere else. With `tangents`, warps are read from TANGENT
/// where a mesh has it, with NORMAL and UVs. FileError names what is damaged, missing or, like
/// Draco and meshopt compression, not supported.
GltfModel read_gltf(const std::filesystem::path& path, bool tangents = false);

} // namespace rapport
