#pragma once

#include <glm/glm.hpp>
#include <optional>
#include <string>
#include <tiny_gltf.h>
#include <vector>

namespace rapport {

/// The nodes of a glTF's scene: the default one, else scene 0, else all nodes that are nobody's
/// child. FileError if they are no tree.
class GltfNodes {
  public:
    GltfNodes(const tinygltf::Model& file, const std::string& path);

    /// In the order of the tree, parents first.
    const std::vector<int>& in_order() const { return in_order_; }
    /// From a node's space to the world's; nothing for a node that the scene does not show.
    const std::optional<glm::dmat4>& to_world(int node) const {
        return to_world_[static_cast<size_t>(node)];
    }

  private:
    std::vector<int> roots() const;
    glm::dmat4 local_transform(const tinygltf::Node& node, const std::string& place) const;

    const tinygltf::Model& file_;
    const std::string& path_;
    std::vector<int> in_order_;
    std::vector<std::optional<glm::dmat4>> to_world_;
};

} // namespace rapport
