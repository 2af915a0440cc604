#pragma once

#include "renderer/scene/gltf_accessor.h"
#include "renderer/scene/mesh.h"

namespace rapport {

/// Reads one primitive in its mesh's own space: triangles, strips and fans, indexed or not; UVs
/// transformed by KHR_texture_transform of the base colour texture, then v ← 1 − v; equal values
/// merged and triangles without area dropped (mesh_cleaning.h). A primitive without triangles is
/// empty. What is ignored or dropped goes to `warnings`, after `place`, which also names the
/// primitive in FileErrors.
IndexedMesh read_gltf_primitive(const tinygltf::Model& model, const GltfAccessors& accessors,
                                const tinygltf::Primitive& primitive, const std::string& path,
                                const std::string& place, std::vector<std::string>& warnings);

} // namespace rapport
