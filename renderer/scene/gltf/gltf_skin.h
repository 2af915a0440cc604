#pragma once

#include "renderer/scene/gltf/gltf_accessor.h"
#include "renderer/scene/gltf/gltf_nodes.h"

namespace rapport {

/// Where the joints of a skin stand, for the vertices that hang on them: per joint the map from the
/// mesh's space to the world's, the joint's own place after its inverse bind matrix.
std::vector<glm::dmat4> gltf_joint_matrices(const tinygltf::Model& file, const GltfNodes& nodes,
                                            const GltfAccessors& accessors, int skin,
                                            const std::string& path);

struct SkinReport {
    size_t unweighted = 0; ///< vertices that hang on no joint, and stay where they are
    bool mirrored = false; ///< most vertices lie in joints that turn the mesh inside out
};

/// Moves vertices, and turns their normals and warps where there are any, by the mean of their
/// joints' matrices, weighted as the primitive says (JOINTS_n and WEIGHTS_n, for all n; weights are
/// scaled to sum to 1). `place` names the primitive in FileErrors.
SkinReport apply_gltf_skin(const tinygltf::Primitive& primitive, const GltfAccessors& accessors,
                           const std::vector<glm::dmat4>& joints, const std::string& path,
                           const std::string& place, std::vector<glm::vec3>& positions,
                           std::vector<glm::vec3>& normals, std::vector<glm::vec3>& warps);

} // namespace rapport
