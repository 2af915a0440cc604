#include "renderer/scene/gltf/gltf_primitive.h"

#include "renderer/core/error.h"
#include "renderer/scene/gltf/gltf_material.h"
#include "renderer/scene/gltf/gltf_skin.h"

#include <algorithm>
#include <fmt/format.h>
#include <numeric>

namespace rapport {
namespace {

/// Reads one primitive; the members are what every step needs.
class PrimitiveReader {
  public:
    PrimitiveReader(const tinygltf::Model& model, const GltfAccessors& accessors,
                    const tinygltf::Primitive& primitive, const GltfPose& pose, bool tangents,
                    const std::string& path, const std::string& place,
                    std::vector<std::string>& warnings)
        : model_(model), accessors_(accessors), primitive_(primitive), pose_(pose),
          tangents_(tangents), path_(path), place_(place), warnings_(warnings) {}

    GltfPrimitive run() {
        if (primitive_.mode >= 0 && primitive_.mode < TINYGLTF_MODE_TRIANGLES) {
            warn("points and lines are ignored");
            return {};
        }
        const int positions = accessor_of("POSITION");
        if (positions < 0) {
            warn("a primitive without POSITION is ignored");
            return {};
        }
        refuse_draco(positions);
        if (primitive_.material >= 0 &&
            static_cast<size_t>(primitive_.material) >= model_.materials.size())
            fail(place_ + ".material", fmt::format("one of {} materials", model_.materials.size()),
                 fmt::format("{}", primitive_.material));

        GltfPrimitive result;
        IndexedMesh& mesh = result.mesh;
        mesh.positions = accessors_.vec3s(positions, attribute_place("POSITION"));
        mesh.position_index = triangles(mesh.positions.size());
        add_morph_targets("POSITION", mesh.positions);
        if (const int normals = accessor_of("NORMAL"); normals >= 0) {
            mesh.normals = accessors_.vec3s(normals, attribute_place("NORMAL"));
            check_count(attribute_place("NORMAL"), mesh.normals.size());
            mesh.normal_index = mesh.position_index;
            add_morph_targets("NORMAL", mesh.normals);
        }
        read_uvs(mesh);
        read_colors(mesh);
        if (tangents_ && !mesh.uvs.empty() && !mesh.normals.empty())
            read_warps(mesh);
        if (pose_.joints) {
            const SkinReport skin =
                apply_gltf_skin(primitive_, accessors_, *pose_.joints, path_, place_,
                                mesh.positions, mesh.normals, mesh.warps);
            result.mirrored = skin.mirrored;
            if (skin.unweighted > 0)
                warn(fmt::format("{} vertices hang on no joint of the skin and stay in place",
                                 skin.unweighted));
        }
        return result;
    }

  private:
    [[noreturn]] void fail(const std::string& place, const std::string& expected,
                           const std::string& found) const {
        throw FileError(path_, place, expected, found);
    }
    void warn(const std::string& text) const {
        warnings_.push_back(fmt::format("{}: {}", place_, text));
    }
    std::string attribute_place(const std::string& name) const {
        return fmt::format("{}.attributes.{}", place_, name);
    }

    int accessor_of(const std::string& attribute) const {
        const auto found = primitive_.attributes.find(attribute);
        return found == primitive_.attributes.end() ? -1 : found->second;
    }

    /// Positions without data are all 0; with this extension, declared or not, they are compressed.
    void refuse_draco(int positions) const {
        constexpr const char* kDraco = "KHR_draco_mesh_compression";
        if (static_cast<size_t>(positions) < model_.accessors.size() &&
            model_.accessors[static_cast<size_t>(positions)].bufferView < 0 &&
            primitive_.extensions.contains(kDraco))
            fail(attribute_place("POSITION"), "a bufferView",
                 fmt::format("not supported: {}", kDraco));
    }

    void check_count(const std::string& place, size_t count) const {
        const size_t expected =
            model_.accessors[static_cast<size_t>(accessor_of("POSITION"))].count;
        if (count != expected)
            fail(place, fmt::format("{} elements, as POSITION has", expected),
                 fmt::format("{}", count));
    }

    void read_uvs(IndexedMesh& mesh) const {
        const GltfUvs source = gltf_uvs(model_, primitive_, path_);
        if (source.accessor < 0)
            return;
        const std::string place = attribute_place(source.attribute);
        mesh.uvs = accessors_.vec2s(source.accessor, place);
        check_count(place, mesh.uvs.size());
        add_morph_targets(source.attribute, mesh.uvs);
        for (glm::vec2& uv : mesh.uvs) {
            uv = source.transform(uv);
            uv.y = 1 - uv.y;
            if (!std::isfinite(uv.x) || !std::isfinite(uv.y))
                fail(place, "UVs that stay finite when transformed", "an overflow");
        }
        mesh.uv_index = mesh.position_index;
    }

    /// COLOR_0, where it is not white throughout.
    void read_colors(IndexedMesh& mesh) const {
        const int accessor = accessor_of("COLOR_0");
        if (accessor < 0)
            return;
        const std::string place = attribute_place("COLOR_0");
        mesh.colors = colors(accessor, place, 1);
        check_count(place, mesh.colors.size());
        add_morph_targets("COLOR_0", mesh.colors);
        bool white = true;
        for (glm::vec4& color : mesh.colors) {
            color = glm::clamp(color, 0.0f, 1.0f);
            white = white && color == glm::vec4(1);
        }
        if (white)
            mesh.colors.clear();
        else
            mesh.color_index = mesh.position_index;
    }

    /// Colours with `alpha` where they have none of their own.
    std::vector<glm::vec4> colors(int accessor, const std::string& place, float alpha) const {
        if (static_cast<size_t>(accessor) < model_.accessors.size() &&
            model_.accessors[static_cast<size_t>(accessor)].type == TINYGLTF_TYPE_VEC4)
            return accessors_.vec4s(accessor, place);
        std::vector<glm::vec4> result;
        for (const glm::vec3& color : accessors_.vec3s(accessor, place))
            result.emplace_back(color, alpha);
        return result;
    }

    /// The warp lies along the bitangent, the sign of which says on which side of the tangent it
    /// is; that is +v, upwards in the texture.
    void read_warps(IndexedMesh& mesh) const {
        const int accessor = accessor_of("TANGENT");
        if (accessor < 0)
            return;
        const std::string place = attribute_place("TANGENT");
        const std::vector<glm::vec4> tangents = accessors_.vec4s(accessor, place);
        check_count(place, tangents.size());
        std::vector<glm::vec3> directions(tangents.begin(), tangents.end());
        add_morph_targets("TANGENT", directions);
        for (size_t v = 0; v < tangents.size(); ++v)
            mesh.warps.push_back(std::copysign(1.0f, tangents[v].w) *
                                 glm::cross(mesh.normals[v], directions[v]));
    }

    /// Adds the displacements of each morph target, times its weight, to an attribute.
    template <class Value>
    void add_morph_targets(const std::string& attribute, std::vector<Value>& values) const {
        const size_t targets = primitive_.targets.size();
        if (!pose_.weights.empty() && pose_.weights.size() != targets)
            fail(place_ + ".targets", fmt::format("{}, one for each weight", pose_.weights.size()),
                 fmt::format("{}", targets));
        for (size_t t = 0; t < pose_.weights.size(); ++t) {
            const auto found = primitive_.targets[t].find(attribute);
            const double weight = pose_.weights[t];
            if (weight == 0 || found == primitive_.targets[t].end())
                continue;
            const std::string place = fmt::format("{}.targets[{}].{}", place_, t, attribute);
            std::vector<Value> displacements;
            if constexpr (Value::length() == 2)
                displacements = accessors_.vec2s(found->second, place);
            else if constexpr (Value::length() == 4)
                displacements = colors(found->second, place, 0);
            else
                displacements = accessors_.vec3s(found->second, place);
            check_count(place, displacements.size());
            for (size_t v = 0; v < values.size(); ++v)
                values[v] += static_cast<float>(weight) * displacements[v];
        }
    }

    std::vector<glm::uvec3> triangles(size_t vertex_count) const {
        std::vector<uint32_t> corner;
        if (primitive_.indices >= 0) {
            corner = accessors_.indices(primitive_.indices, vertex_count, place_ + ".indices");
        } else {
            corner.resize(vertex_count);
            std::iota(corner.begin(), corner.end(), 0u);
        }
        const bool is_list = primitive_.mode < 0 || primitive_.mode == TINYGLTF_MODE_TRIANGLES;
        if (corner.size() < 3 || (is_list && corner.size() % 3 != 0))
            fail(place_ + (primitive_.indices >= 0 ? ".indices" : ".attributes.POSITION"),
                 is_list ? "a multiple of 3 corners" : "3 corners or more",
                 fmt::format("{}", corner.size()));
        std::vector<glm::uvec3> result;
        result.reserve(is_list ? corner.size() / 3 : corner.size() - 2);
        if (is_list) {
            for (size_t i = 0; i < corner.size(); i += 3)
                result.emplace_back(corner[i], corner[i + 1], corner[i + 2]);
        } else if (primitive_.mode == TINYGLTF_MODE_TRIANGLE_STRIP) {
            for (size_t i = 0; i + 2 < corner.size(); ++i) // every second one runs the other way
                result.emplace_back(corner[i], corner[i + 1 + i % 2], corner[i + 2 - i % 2]);
        } else if (primitive_.mode == TINYGLTF_MODE_TRIANGLE_FAN) {
            for (size_t i = 1; i + 1 < corner.size(); ++i)
                result.emplace_back(corner[i], corner[i + 1], corner[0]);
        } else {
            fail(place_ + ".mode", "a number from 0 to 6", fmt::format("{}", primitive_.mode));
        }
        return result;
    }

    const tinygltf::Model& model_;
    const GltfAccessors& accessors_;
    const tinygltf::Primitive& primitive_;
    const GltfPose& pose_;
    bool tangents_;
    const std::string& path_;
    const std::string& place_;
    std::vector<std::string>& warnings_;
};

} // namespace

GltfPrimitive read_gltf_primitive(const tinygltf::Model& model, const GltfAccessors& accessors,
                                  const tinygltf::Primitive& primitive, const GltfPose& pose,
                                  bool tangents, const std::string& path, const std::string& place,
                                  std::vector<std::string>& warnings) {
    return PrimitiveReader(model, accessors, primitive, pose, tangents, path, place, warnings)
        .run();
}

} // namespace rapport
