#pragma once

#include "renderer/scene/gltf/gltf_accessor.h"
#include "renderer/scene/picture.h"

#include <string>
#include <tiny_gltf.h>

namespace rapport {

/// KHR_texture_transform in glTF's v-down coordinates: scaled, turned counter-clockwise as the
/// picture is seen, then moved.
struct TextureTransform {
    glm::dvec2 offset{0}, scale{1};
    double rotation = 0; ///< [rad]

    glm::vec2 operator()(const glm::vec2& uv) const;
};

/// The UVs of a primitive: those of its base colour texture, along which a cloth is laid, too; the
/// first set, untransformed, where there is no such texture or the primitive lacks its set.
struct GltfUvs {
    int accessor = -1; ///< none
    std::string attribute;
    TextureTransform transform;
};
GltfUvs gltf_uvs(const tinygltf::Model& file, const tinygltf::Primitive& primitive,
                 const std::string& path);

/// Base colour and opacity of a material, `file.materials[material]`. A texture whose picture is
/// missing or in a form that is not read is left out, told in `warnings`.
BaseColor gltf_base_color(const tinygltf::Model& file, const GltfAccessors& accessors, int material,
                          const std::string& path, std::vector<std::string>& warnings);

} // namespace rapport
