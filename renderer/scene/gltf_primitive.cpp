#include "renderer/scene/gltf_primitive.h"

#include "renderer/core/error.h"
#include "renderer/scene/mesh_cleaning.h"

#include <algorithm>
#include <fmt/format.h>
#include <numeric>

namespace rapport {
namespace {

/// KHR_texture_transform of texture coordinate set 0, in glTF's v-down coordinates: scaled, turned
/// counter-clockwise as the picture is seen, then moved.
struct TextureTransform {
    glm::dvec2 offset{0}, scale{1};
    double rotation = 0;

    glm::vec2 operator()(const glm::vec2& uv) const {
        const glm::dvec2 scaled = scale * glm::dvec2(uv);
        const double c = std::cos(rotation), s = std::sin(rotation);
        return glm::dvec2(c * scaled.x + s * scaled.y, c * scaled.y - s * scaled.x) + offset;
    }
};

/// Reads one primitive; the members are what every step needs.
class PrimitiveReader {
  public:
    PrimitiveReader(const tinygltf::Model& model, const GltfAccessors& accessors,
                    const tinygltf::Primitive& primitive, const std::string& path,
                    const std::string& place, std::vector<std::string>& warnings)
        : model_(model), accessors_(accessors), primitive_(primitive), path_(path), place_(place),
          warnings_(warnings) {}

    IndexedMesh run() {
        if (primitive_.mode >= 0 && primitive_.mode < TINYGLTF_MODE_TRIANGLES) {
            warn("points and lines are ignored");
            return {};
        }
        if (!primitive_.targets.empty())
            warn("morph targets are ignored");
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

        IndexedMesh mesh;
        mesh.positions = accessors_.vec3s(positions, attribute_place("POSITION"));
        mesh.position_index = triangles(mesh.positions.size());
        if (const int uvs = accessor_of("TEXCOORD_0"); uvs >= 0) {
            mesh.uvs = accessors_.vec2s(uvs, attribute_place("TEXCOORD_0"));
            check_count("TEXCOORD_0", mesh.uvs.size(), mesh.positions.size());
            mesh.uv_index = mesh.position_index;
            const TextureTransform transform = texture_transform();
            for (glm::vec2& uv : mesh.uvs) {
                uv = transform(uv);
                uv.y = 1 - uv.y;
                if (!std::isfinite(uv.x) || !std::isfinite(uv.y))
                    fail(attribute_place("TEXCOORD_0"), "UVs that stay finite when transformed",
                         "an overflow");
            }
        }
        if (const int normals = accessor_of("NORMAL"); normals >= 0) {
            mesh.normals = accessors_.vec3s(normals, attribute_place("NORMAL"));
            check_count("NORMAL", mesh.normals.size(), mesh.positions.size());
            mesh.normal_index = mesh.position_index;
        }
        CleaningReport dropped;
        mesh = clean(mesh, &dropped);
        if (dropped.degenerate > 0)
            warn(fmt::format("{} triangles with two corners at one point were dropped",
                             dropped.degenerate));
        if (dropped.repeated > 0)
            warn(fmt::format("{} triangles that lie on another were dropped", dropped.repeated));
        return mesh;
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

    void check_count(const std::string& attribute, size_t count, size_t expected) const {
        if (count != expected)
            fail(attribute_place(attribute), fmt::format("{} elements, as POSITION has", expected),
                 fmt::format("{}", count));
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

    TextureTransform texture_transform() const {
        TextureTransform transform;
        if (primitive_.material < 0)
            return transform;
        const tinygltf::TextureInfo& texture =
            model_.materials[static_cast<size_t>(primitive_.material)]
                .pbrMetallicRoughness.baseColorTexture;
        const auto found = texture.extensions.find("KHR_texture_transform");
        if (found == texture.extensions.end())
            return transform;
        const tinygltf::Value& value = found->second;
        const std::string place = fmt::format(
            "materials[{}].pbrMetallicRoughness.baseColorTexture.extensions.KHR_texture_transform",
            primitive_.material);
        int set = texture.texCoord;
        if (value.Has("texCoord"))
            set = static_cast<int>(number(value.Get("texCoord"), place + ".texCoord"));
        if (set != 0) // it moves other coordinates than those that are read
            return {};
        if (value.Has("rotation"))
            transform.rotation = number(value.Get("rotation"), place + ".rotation");
        if (value.Has("offset"))
            transform.offset = pair(value.Get("offset"), place + ".offset");
        if (value.Has("scale"))
            transform.scale = pair(value.Get("scale"), place + ".scale");
        return transform;
    }

    double number(const tinygltf::Value& value, const std::string& place) const {
        if (!value.IsNumber())
            fail(place, "a number", "another type");
        return value.GetNumberAsDouble();
    }
    glm::dvec2 pair(const tinygltf::Value& value, const std::string& place) const {
        if (!value.IsArray() || value.ArrayLen() != 2)
            fail(place, "an array of 2 numbers", "something else");
        return {number(value.Get(0), place), number(value.Get(1), place)};
    }

    const tinygltf::Model& model_;
    const GltfAccessors& accessors_;
    const tinygltf::Primitive& primitive_;
    const std::string& path_;
    const std::string& place_;
    std::vector<std::string>& warnings_;
};

} // namespace

IndexedMesh read_gltf_primitive(const tinygltf::Model& model, const GltfAccessors& accessors,
                                const tinygltf::Primitive& primitive, const std::string& path,
                                const std::string& place, std::vector<std::string>& warnings) {
    return PrimitiveReader(model, accessors, primitive, path, place, warnings).run();
}

} // namespace rapport
