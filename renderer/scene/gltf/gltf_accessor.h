#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <string>
#include <tiny_gltf.h>
#include <vector>

namespace rapport {

/// Reads accessors of a glTF with every index and offset checked, also sparse, interleaved and
/// quantised ones. `place` names what refers to the accessor, for FileErrors.
class GltfAccessors {
  public:
    GltfAccessors(const tinygltf::Model& model, std::string path);

    /// Finite coordinates; integers become numbers, normalised ones in [−1, 1] or [0, 1].
    std::vector<glm::vec2> vec2s(int accessor, const std::string& place) const;
    std::vector<glm::vec3> vec3s(int accessor, const std::string& place) const;
    std::vector<glm::vec4> vec4s(int accessor, const std::string& place) const;
    /// Floats only, finite.
    std::vector<glm::mat4> mat4s(int accessor, const std::string& place) const;
    /// Unsigned integers, each below `limit`.
    std::vector<uint32_t> indices(int accessor, uint64_t limit, const std::string& place) const;
    /// All bytes of a bufferView.
    std::span<const unsigned char> bytes(int buffer_view, const std::string& place) const;

  private:
    struct View;
    template <glm::length_t N>
    std::vector<glm::vec<N, float>> vectors(int accessor, int type, const std::string& place) const;
    const tinygltf::Accessor& find(int accessor, const std::string& place) const;
    View view(int buffer_view, size_t offset, size_t count, size_t element_size,
              const std::string& place) const;
    template <class Store>
    void for_each_component(const tinygltf::Accessor& accessor, const std::string& place,
                            const Store& store) const;
    std::vector<uint64_t> sparse_indices(const tinygltf::Accessor& accessor,
                                         const std::string& place) const;
    [[noreturn]] void fail(const std::string& place, const std::string& expected,
                           const std::string& found) const;

    const tinygltf::Model& model_;
    std::string path_;
    size_t buffer_bytes_ = 0;
};

} // namespace rapport
