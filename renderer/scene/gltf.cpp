#include "renderer/scene/gltf.h"

#include "renderer/core/error.h"
#include "renderer/scene/gltf_file.h"
#include "renderer/scene/gltf_primitive.h"

#include <algorithm>
#include <fmt/format.h>
#include <glm/gtc/matrix_transform.hpp>
#include <glm/gtc/quaternion.hpp>
#include <glm/gtc/type_ptr.hpp>

namespace rapport {
namespace {

/// Bounds on what many nodes that show one mesh may ask for, and on coordinates, which ray tracing
/// in single precision must be able to square.
constexpr size_t kMaxTriangles = size_t{1} << 28;
constexpr float kMaxCoordinate = 1e18f;

struct Placement {
    int mesh;
    glm::dmat4 to_world;
    std::string node; ///< for messages
};

class ModelReader {
  public:
    explicit ModelReader(const std::filesystem::path& path)
        : path_(path.string()), file_(load_gltf_file(path, model_.warnings)),
          accessors_(file_, path_), primitives_(file_.meshes.size()) {}

    GltfModel run() {
        const std::vector<Placement> shown = placements();
        if (shown.empty())
            fail("", "a scene with a node that shows a mesh", "none");
        for (const Placement& placement : shown)
            place_mesh(placement);
        if (model_.parts.empty())
            fail("", "meshes with triangles", "none");
        return std::move(model_);
    }

  private:
    [[noreturn]] void fail(const std::string& place, const std::string& expected,
                           const std::string& found) const {
        throw FileError(path_, place, expected, found);
    }

    /// The default scene's nodes, else scene 0's, else all that are nobody's child.
    std::vector<int> root_nodes() const {
        if (file_.defaultScene >= 0 || !file_.scenes.empty()) {
            const auto scene = static_cast<size_t>(std::max(file_.defaultScene, 0));
            if (scene >= file_.scenes.size())
                fail("scene", fmt::format("one of {} scenes", file_.scenes.size()),
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
            fail("nodes", "a node that is no other's child", "a cycle");
        return roots;
    }

    /// Where meshes stand, in the order of the node tree.
    std::vector<Placement> placements() const {
        struct Visit {
            int node;
            glm::dmat4 parent;
        };
        std::vector<Visit> pending; // a stack of our own: chains of nodes may be long
        const auto push = [&](const std::vector<int>& nodes, const glm::dmat4& parent) {
            for (auto node = nodes.rbegin(); node != nodes.rend(); ++node)
                pending.push_back({*node, parent});
        };
        push(root_nodes(), glm::dmat4(1));
        std::vector<char> visited(file_.nodes.size(), 0);
        std::vector<Placement> result;
        while (!pending.empty()) {
            const Visit visit = pending.back();
            pending.pop_back();
            const std::string place = fmt::format("nodes[{}]", visit.node);
            if (visit.node < 0 || static_cast<size_t>(visit.node) >= file_.nodes.size())
                fail(place, fmt::format("one of {} nodes", file_.nodes.size()), "none");
            if (visited[static_cast<size_t>(visit.node)])
                fail(place, "a tree of nodes", "a node that is reached twice");
            visited[static_cast<size_t>(visit.node)] = 1;
            const tinygltf::Node& node = file_.nodes[static_cast<size_t>(visit.node)];
            const glm::dmat4 to_world = visit.parent * local_transform(node, place);
            if (node.mesh >= 0)
                result.push_back({node.mesh, to_world, place});
            push(node.children, to_world);
        }
        return result;
    }

    glm::dmat4 local_transform(const tinygltf::Node& node, const std::string& place) const {
        if (!node.matrix.empty())
            return glm::make_mat4(node.matrix.data());
        glm::dmat4 transform(1);
        if (!node.translation.empty())
            transform = glm::translate(transform, glm::make_vec3(node.translation.data()));
        if (!node.rotation.empty()) {
            const glm::dquat rotation(node.rotation[3], node.rotation[0], node.rotation[1],
                                      node.rotation[2]);
            if (!(glm::length(rotation) > 0))
                fail(place + ".rotation", "a unit quaternion", "zero");
            transform *= glm::mat4_cast(glm::normalize(rotation));
        }
        if (!node.scale.empty())
            transform = glm::scale(transform, glm::make_vec3(node.scale.data()));
        return transform;
    }

    void place_mesh(const Placement& placement) {
        if (static_cast<size_t>(placement.mesh) >= file_.meshes.size())
            fail(placement.node + ".mesh", fmt::format("one of {} meshes", file_.meshes.size()),
                 fmt::format("{}", placement.mesh));
        const tinygltf::Mesh& mesh = file_.meshes[static_cast<size_t>(placement.mesh)];
        const double determinant = glm::determinant(glm::dmat3(placement.to_world));
        if (determinant == 0 || !std::isfinite(determinant)) {
            warn(placement.node, "its transform cannot be inverted: ignored");
            return;
        }
        if (determinant < 0)
            warn(placement.node, "mirrored by its transform: triangles turned round, so that the "
                                 "face side stays what it is");
        const std::vector<IndexedMesh>& primitives = primitives_of(placement.mesh);
        for (size_t p = 0; p < primitives.size(); ++p) {
            if (primitives[p].position_index.empty())
                continue;
            triangles_ += primitives[p].position_index.size();
            if (triangles_ > kMaxTriangles)
                fail(placement.node, fmt::format("at most {} triangles in all", kMaxTriangles),
                     "more");
            GltfPart part;
            part.name = mesh.name.empty() ? fmt::format("meshes[{}]", placement.mesh) : mesh.name;
            if (primitives.size() > 1)
                part.name += fmt::format(".primitives[{}]", p);
            if (const int material = mesh.primitives[p].material; material >= 0)
                part.material = file_.materials[static_cast<size_t>(material)].name;
            part.mesh = transformed(primitives[p], placement);
            model_.parts.push_back(std::move(part));
        }
    }

    const std::vector<IndexedMesh>& primitives_of(int mesh) {
        std::vector<IndexedMesh>& primitives = primitives_[static_cast<size_t>(mesh)];
        const std::vector<tinygltf::Primitive>& source =
            file_.meshes[static_cast<size_t>(mesh)].primitives;
        if (primitives.empty())
            for (size_t p = 0; p < source.size(); ++p)
                primitives.push_back(read_gltf_primitive(
                    file_, accessors_, source[p], path_,
                    fmt::format("meshes[{}].primitives[{}]", mesh, p), model_.warnings));
        return primitives;
    }

    IndexedMesh transformed(IndexedMesh mesh, const Placement& placement) const {
        for (glm::vec3& p : mesh.positions) {
            p = glm::vec3(placement.to_world * glm::dvec4(p, 1));
            if (!(std::max({std::abs(p.x), std::abs(p.y), std::abs(p.z)}) < kMaxCoordinate))
                fail(placement.node, "positions below 1e18 m", "larger ones");
        }
        const glm::dmat3 normal_map = glm::transpose(glm::inverse(glm::dmat3(placement.to_world)));
        for (glm::vec3& n : mesh.normals) {
            const glm::dvec3 normal = normal_map * glm::dvec3(n);
            const double length = glm::length(normal);
            n = length > 0 && std::isfinite(length) ? glm::vec3(normal / length) : glm::vec3(0);
        }
        if (glm::determinant(glm::dmat3(placement.to_world)) < 0)
            for (auto* index : {&mesh.position_index, &mesh.uv_index, &mesh.normal_index})
                for (glm::uvec3& triangle : *index)
                    std::swap(triangle.y, triangle.z);
        return mesh;
    }

    void warn(const std::string& place, const std::string& text) {
        model_.warnings.push_back(fmt::format("{}: {}", place, text));
    }

    std::string path_;
    GltfModel model_;
    tinygltf::Model file_;
    GltfAccessors accessors_;
    std::vector<std::vector<IndexedMesh>> primitives_; ///< per mesh, read when first placed
    size_t triangles_ = 0;
};

} // namespace

GltfModel read_gltf(const std::filesystem::path& path) { return ModelReader(path).run(); }

} // namespace rapport
