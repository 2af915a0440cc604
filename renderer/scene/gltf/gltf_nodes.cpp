#include "renderer/scene/gltf/gltf_nodes.h"

#include "renderer/core/error.h"

#include <algorithm>
#include <fmt/format.h>
#include <glm/gtc/matrix_transform.hpp>
#include <glm/gtc/quaternion.hpp>
#include <glm/gtc/type_ptr.hpp>

namespace rapport {

GltfNodes::GltfNodes(const tinygltf::Model& file, const std::string& path)
    : file_(file), path_(path), to_world_(file.nodes.size()) {
    struct Visit {
        int node;
        glm::dmat4 parent;
    };
    std::vector<Visit> pending; // a stack of our own: chains of nodes may be long
    const auto push = [&](const std::vector<int>& nodes, const glm::dmat4& parent) {
        for (auto node = nodes.rbegin(); node != nodes.rend(); ++node)
            pending.push_back({*node, parent});
    };
    push(roots(), glm::dmat4(1));
    while (!pending.empty()) {
        const Visit visit = pending.back();
        pending.pop_back();
        const std::string place = fmt::format("nodes[{}]", visit.node);
        if (visit.node < 0 || static_cast<size_t>(visit.node) >= file.nodes.size())
            throw FileError(path, place, fmt::format("one of {} nodes", file.nodes.size()), "none");
        std::optional<glm::dmat4>& to_world = to_world_[static_cast<size_t>(visit.node)];
        if (to_world)
            throw FileError(path, place, "a tree of nodes", "a node that is reached twice");
        const tinygltf::Node& node = file.nodes[static_cast<size_t>(visit.node)];
        to_world = visit.parent * local_transform(node, place);
        in_order_.push_back(visit.node);
        push(node.children, *to_world);
    }
}

std::vector<int> GltfNodes::roots() const {
    if (file_.defaultScene >= 0 || !file_.scenes.empty()) {
        const auto scene = static_cast<size_t>(std::max(file_.defaultScene, 0));
        if (scene >= file_.scenes.size())
            throw FileError(path_, "scene", fmt::format("one of {} scenes", file_.scenes.size()),
                            fmt::format("{}", scene));
        return file_.scenes[scene].nodes;
    }
    std::vector<char> is_child(file_.nodes.size(), 0);
    for (const tinygltf::Node& node : file_.nodes)
        for (const int child : node.children)
            if (child >= 0 && static_cast<size_t>(child) < is_child.size())
                is_child[static_cast<size_t>(child)] = 1;
    std::vector<int> roots;
    for (size_t i = 0; i < file_.nodes.size(); ++i)
        if (!is_child[i])
            roots.push_back(static_cast<int>(i));
    if (roots.empty() && !file_.nodes.empty())
        throw FileError(path_, "nodes", "a node that is no other's child", "a cycle");
    return roots;
}

glm::dmat4 GltfNodes::local_transform(const tinygltf::Node& node, const std::string& place) const {
    if (!node.matrix.empty())
        return glm::make_mat4(node.matrix.data());
    glm::dmat4 transform(1);
    if (!node.translation.empty())
        transform = glm::translate(transform, glm::make_vec3(node.translation.data()));
    if (!node.rotation.empty()) {
        const glm::dquat rotation(node.rotation[3], node.rotation[0], node.rotation[1],
                                  node.rotation[2]);
        if (!(glm::length(rotation) > 0))
            throw FileError(path_, place + ".rotation", "a unit quaternion", "zero");
        transform *= glm::mat4_cast(glm::normalize(rotation));
    }
    if (!node.scale.empty())
        transform = glm::scale(transform, glm::make_vec3(node.scale.data()));
    return transform;
}

} // namespace rapport
