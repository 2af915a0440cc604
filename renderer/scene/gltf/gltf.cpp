#include "renderer/scene/gltf/gltf.h"

#include "renderer/core/error.h"
#include "renderer/scene/gltf/gltf_file.h"
#include "renderer/scene/gltf/gltf_material.h"
#include "renderer/scene/gltf/gltf_primitive.h"
#include "renderer/scene/gltf/gltf_skin.h"
#include "renderer/scene/mesh/mesh_operations.h"

#include <algorithm>
#include <fmt/format.h>
#include <optional>
#include <set>

namespace rapport {
namespace {

/// Bound on what many nodes that show one mesh may ask for.
constexpr size_t kMaxTriangles = size_t{1} << 28;

/// Whether a map takes any triangle to one with an area.
bool keeps_areas(const glm::dmat3& map) {
    const glm::dvec3 none(0);
    return glm::cross(map[0], map[1]) != none || glm::cross(map[1], map[2]) != none ||
           glm::cross(map[2], map[0]) != none;
}

class ModelReader {
  public:
    ModelReader(const std::filesystem::path& path, bool tangents)
        : path_(path.string()), tangents_(tangents), file_(load_gltf_file(path, model_.warnings)),
          accessors_(file_, path_), nodes_(file_, path_), primitives_(file_.meshes.size()),
          colors_(file_.materials.size()) {}

    GltfModel run() {
        bool shows_mesh = false;
        for (const int node : nodes_.in_order())
            if (file_.nodes[static_cast<size_t>(node)].mesh >= 0) {
                shows_mesh = true;
                place_mesh(node);
            }
        if (!shows_mesh) {
            for (size_t mesh = 0; mesh < file_.meshes.size(); ++mesh) // what is damaged comes first
                primitives_of(static_cast<int>(mesh));
            fail("", "a scene with a node that shows a mesh", "none");
        }
        if (model_.parts.empty())
            fail("", "meshes with triangles",
                 model_.warnings.empty() ? "none"
                                         : fmt::format("none ({})", model_.warnings.back()));
        tell_ignored();
        return std::move(model_);
    }

  private:
    [[noreturn]] void fail(const std::string& place, const std::string& expected,
                           const std::string& found) const {
        throw FileError(path_, place, expected, found);
    }

    void place_mesh(int node_index) {
        const tinygltf::Node& node = file_.nodes[static_cast<size_t>(node_index)];
        const std::string place = fmt::format("nodes[{}]", node_index);
        if (static_cast<size_t>(node.mesh) >= file_.meshes.size())
            fail(place + ".mesh", fmt::format("one of {} meshes", file_.meshes.size()),
                 fmt::format("{}", node.mesh));
        // A skinned mesh goes where its joints are, not where its node is.
        const glm::dmat4 to_world = node.skin >= 0 ? glm::dmat4(1) : *nodes_.to_world(node_index);
        const double determinant = glm::determinant(glm::dmat3(to_world));
        if (!std::isfinite(determinant) || !keeps_areas(glm::dmat3(to_world))) {
            warn(place, "its transform leaves no surface: ignored");
            return;
        }
        const tinygltf::Mesh& mesh = file_.meshes[static_cast<size_t>(node.mesh)];
        const std::vector<GltfPrimitive> posed = posed_primitives(node);
        const std::vector<GltfPrimitive>& primitives =
            posed.empty() ? primitives_of(node.mesh) : posed;
        bool mirrored = false;
        for (size_t p = 0; p < primitives.size(); ++p) {
            const GltfPrimitive& primitive = primitives[p];
            if (primitive.mesh.position_index.empty())
                continue;
            triangles_ += primitive.mesh.position_index.size();
            if (triangles_ > kMaxTriangles)
                fail(place, fmt::format("at most {} triangles in all", kMaxTriangles), "more");
            const bool turned = primitive.mirrored != (determinant < 0);
            mirrored = mirrored || turned;
            GltfPart part;
            part.mesh = transformed(primitive.mesh, to_world, turned, place);
            if (part.mesh.position_index.empty())
                continue;
            part.name = mesh.name.empty() ? fmt::format("meshes[{}]", node.mesh) : mesh.name;
            if (primitives.size() > 1)
                part.name += fmt::format(".primitives[{}]", p);
            if (const int material = mesh.primitives[p].material; material >= 0) {
                part.material = file_.materials[static_cast<size_t>(material)].name;
                part.base_color = color_of(material);
            } else if (!part.mesh.colors.empty()) {
                part.base_color.factor = Rgb(1);
            }
            model_.parts.push_back(std::move(part));
        }
        if (mirrored)
            warn(place, "mirrored by its transform: triangles turned round, so that the face side "
                        "stays what it is");
    }

    /// The primitives of a node that has a skin or weights of its own; else none.
    std::vector<GltfPrimitive> posed_primitives(const tinygltf::Node& node) {
        if (node.skin < 0 && node.weights.empty())
            return {};
        GltfPose pose{node.weights.empty() ? file_.meshes[static_cast<size_t>(node.mesh)].weights
                                           : node.weights};
        std::vector<glm::dmat4> joints;
        if (node.skin >= 0) {
            joints = gltf_joint_matrices(file_, nodes_, accessors_, node.skin, path_);
            pose.joints = &joints;
        }
        return read_primitives(node.mesh, pose);
    }

    const std::vector<GltfPrimitive>& primitives_of(int mesh) {
        std::vector<GltfPrimitive>& primitives = primitives_[static_cast<size_t>(mesh)];
        if (primitives.empty())
            primitives = read_primitives(mesh, {file_.meshes[static_cast<size_t>(mesh)].weights});
        return primitives;
    }

    std::vector<GltfPrimitive> read_primitives(int mesh, const GltfPose& pose) {
        const std::vector<tinygltf::Primitive>& source =
            file_.meshes[static_cast<size_t>(mesh)].primitives;
        std::vector<GltfPrimitive> primitives;
        for (size_t p = 0; p < source.size(); ++p)
            primitives.push_back(read_gltf_primitive(
                file_, accessors_, source[p], pose, tangents_, path_,
                fmt::format("meshes[{}].primitives[{}]", mesh, p), model_.warnings));
        return primitives;
    }

    const BaseColor& color_of(int material) {
        std::optional<BaseColor>& color = colors_[static_cast<size_t>(material)];
        if (!color)
            color = gltf_base_color(file_, accessors_, material, path_, model_.warnings);
        return *color;
    }

    IndexedMesh transformed(IndexedMesh mesh, const glm::dmat4& to_world, bool turned,
                            const std::string& place) const {
        for (glm::vec3& p : mesh.positions) {
            p = glm::vec3(to_world * glm::dvec4(p, 1));
            if (!(std::max({std::abs(p.x), std::abs(p.y), std::abs(p.z)}) < kMaxCoordinate))
                fail(place, "positions below 1e18 m", "larger ones");
        }
        for (glm::vec3& warp : mesh.warps)
            warp = glm::dmat3(to_world) * glm::dvec3(warp);
        if (glm::determinant(glm::dmat3(to_world)) == 0) { // flattened: all lies in one plane
            mesh.normals.clear();
            mesh.normal_index.clear();
        }
        const glm::dmat3 normal_map = glm::transpose(glm::inverse(glm::dmat3(to_world)));
        for (glm::vec3& n : mesh.normals) {
            const glm::dvec3 normal = normal_map * glm::dvec3(n);
            const double length = glm::length(normal);
            n = length > 0 && std::isfinite(length) ? glm::vec3(normal / length) : glm::vec3(0);
        }
        if (turned)
            for (std::vector<glm::uvec3>* index : mesh.indices())
                for (glm::uvec3& triangle : *index)
                    std::swap(triangle.y, triangle.z);
        return mesh;
    }

    /// What would be seen of the parts where the scene states no material.
    void tell_ignored() {
        std::set<int> meshes, materials;
        for (const int node : nodes_.in_order())
            meshes.insert(file_.nodes[static_cast<size_t>(node)].mesh);
        meshes.erase(-1);
        for (const int mesh : meshes)
            for (const tinygltf::Primitive& primitive :
                 file_.meshes[static_cast<size_t>(mesh)].primitives)
                materials.insert(primitive.material);
        materials.erase(-1);
        const auto shining = std::ranges::count_if(materials, [&](int index) {
            return std::ranges::any_of(file_.materials[static_cast<size_t>(index)].emissiveFactor,
                                       [](double c) { return c > 0; });
        });
        if (shining > 0)
            model_.warnings.push_back(
                fmt::format("{} materials with emission, which is ignored", shining));
    }

    void warn(const std::string& place, const std::string& text) {
        model_.warnings.push_back(fmt::format("{}: {}", place, text));
    }

    std::string path_;
    bool tangents_;
    GltfModel model_;
    tinygltf::Model file_;
    GltfAccessors accessors_;
    GltfNodes nodes_;
    std::vector<std::vector<GltfPrimitive>> primitives_; ///< per mesh, read when first placed
    std::vector<std::optional<BaseColor>> colors_;       ///< per material
    size_t triangles_ = 0;
};

} // namespace

GltfModel read_gltf(const std::filesystem::path& path, bool tangents) {
    return ModelReader(path, tangents).run();
}

} // namespace rapport
