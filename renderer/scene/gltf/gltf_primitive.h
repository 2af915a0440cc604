#pragma once

#include "renderer/scene/gltf/gltf_accessor.h"
#include "renderer/scene/mesh/mesh.h"

namespace rapport {

/// What a node makes of its mesh.
struct GltfPose {
    std::vector<double> weights;                     ///< of the morph targets; empty = all 0
    const std::vector<glm::dmat4>* joints = nullptr; ///< of its skin (gltf_skin.h), if it has one
};

struct GltfPrimitive {
    IndexedMesh mesh;      ///< not cleaned
    bool mirrored = false; ///< turned inside out by its skin
};

/// Reads one primitive: triangles, strips and fans, indexed or not; morph targets at their weights;
/// then moved by the skin, if there is one, else in the mesh's own space; UVs as gltf_material.h
/// says, then v ← 1 − v; with `tangents`, warps from TANGENT and NORMAL, where it has them. A
/// primitive without triangles is empty. What is ignored goes to `warnings`, after `place`, which
/// also names the primitive in FileErrors.
GltfPrimitive read_gltf_primitive(const tinygltf::Model& model, const GltfAccessors& accessors,
                                  const tinygltf::Primitive& primitive, const GltfPose& pose,
                                  bool tangents, const std::string& path, const std::string& place,
                                  std::vector<std::string>& warnings);

} // namespace rapport
