#include "renderer/scene/gltf/gltf_skin.h"

#include "renderer/core/error.h"

#include <cmath>
#include <fmt/format.h>

namespace rapport {

std::vector<glm::dmat4> gltf_joint_matrices(const tinygltf::Model& file, const GltfNodes& nodes,
                                            const GltfAccessors& accessors, int skin,
                                            const std::string& path) {
    const std::string place = fmt::format("skins[{}]", skin);
    if (skin < 0 || static_cast<size_t>(skin) >= file.skins.size())
        throw FileError(path, place, fmt::format("one of {} skins", file.skins.size()), "none");
    const tinygltf::Skin& source = file.skins[static_cast<size_t>(skin)];
    const size_t count = source.joints.size();
    if (count == 0)
        throw FileError(path, place + ".joints", "joints", "none");
    std::vector<glm::dmat4> matrices(count, glm::dmat4(1));
    if (source.inverseBindMatrices >= 0) {
        const std::string where = place + ".inverseBindMatrices";
        const std::vector<glm::mat4> inverse = accessors.mat4s(source.inverseBindMatrices, where);
        if (inverse.size() < count)
            throw FileError(path, where, fmt::format("{} matrices, one for each joint", count),
                            fmt::format("{}", inverse.size()));
        for (size_t j = 0; j < count; ++j)
            matrices[j] = inverse[j];
    }
    for (size_t j = 0; j < count; ++j) {
        const int node = source.joints[j];
        const bool exists = node >= 0 && static_cast<size_t>(node) < file.nodes.size();
        if (!exists || !nodes.to_world(node))
            throw FileError(path, fmt::format("{}.joints[{}]", place, j), "a node of the scene",
                            fmt::format("nodes[{}]", node));
        matrices[j] = *nodes.to_world(node) * matrices[j];
    }
    return matrices;
}

namespace {

/// Sets n = 0, 1, … of joints and weights that a primitive has.
struct Influences {
    std::vector<std::vector<glm::vec4>> joints, weights;
};

Influences read_influences(const tinygltf::Primitive& primitive, const GltfAccessors& accessors,
                           size_t vertices, size_t joints, const std::string& path,
                           const std::string& place) {
    Influences influences;
    for (int set = 0;; ++set) {
        const std::string names[] = {fmt::format("JOINTS_{}", set), fmt::format("WEIGHTS_{}", set)};
        const bool has[] = {primitive.attributes.contains(names[0]),
                            primitive.attributes.contains(names[1])};
        if (has[0] != has[1] || (set == 0 && !has[0]))
            throw FileError(path, place + ".attributes",
                            names[0] + " and " + names[1] + ", since the node has a skin",
                            has[0]   ? "only the former"
                            : has[1] ? "only the latter"
                                     : "neither");
        if (!has[0])
            return influences;
        for (int k = 0; k < 2; ++k) {
            const std::string where = fmt::format("{}.attributes.{}", place, names[k]);
            auto values = accessors.vec4s(primitive.attributes.at(names[k]), where);
            if (values.size() != vertices)
                throw FileError(path, where, fmt::format("{} elements, as POSITION has", vertices),
                                fmt::format("{}", values.size()));
            for (const glm::vec4& value : values)
                for (int c = 0; c < 4; ++c)
                    if (k == 0 ? !(value[c] >= 0 && value[c] < static_cast<float>(joints) &&
                                   value[c] == std::floor(value[c]))
                               : !(value[c] >= 0))
                        throw FileError(path, where,
                                        k == 0 ? fmt::format("joints below {}", joints)
                                               : "weights that are 0 or more",
                                        fmt::format("{}", value[c]));
            (k == 0 ? influences.joints : influences.weights).push_back(std::move(values));
        }
    }
}

} // namespace

SkinReport apply_gltf_skin(const tinygltf::Primitive& primitive, const GltfAccessors& accessors,
                           const std::vector<glm::dmat4>& joints, const std::string& path,
                           const std::string& place, std::vector<glm::vec3>& positions,
                           std::vector<glm::vec3>& normals, std::vector<glm::vec3>& warps) {
    const Influences influences =
        read_influences(primitive, accessors, positions.size(), joints.size(), path, place);
    SkinReport report;
    size_t mirrored = 0;
    for (size_t v = 0; v < positions.size(); ++v) {
        glm::dmat4 mean(0);
        double sum = 0;
        for (size_t set = 0; set < influences.joints.size(); ++set)
            for (int c = 0; c < 4; ++c) {
                const double weight = influences.weights[set][v][c];
                if (weight == 0) // such joints need not even be finite
                    continue;
                mean += weight * joints[static_cast<size_t>(influences.joints[set][v][c])];
                sum += weight;
            }
        if (sum == 0) {
            ++report.unweighted;
            continue;
        }
        mean /= sum;
        positions[v] = mean * glm::dvec4(positions[v], 1);
        const glm::dmat3 linear(mean);
        const double determinant = glm::determinant(linear);
        mirrored += determinant < 0 ? 1 : 0;
        if (!normals.empty() && determinant != 0)
            normals[v] = glm::transpose(glm::inverse(linear)) * glm::dvec3(normals[v]);
        if (!warps.empty())
            warps[v] = linear * glm::dvec3(warps[v]);
    }
    report.mirrored = 2 * mirrored > positions.size();
    return report;
}

} // namespace rapport
