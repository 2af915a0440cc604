#include "renderer/scene/gltf/gltf_accessor.h"

#include "renderer/core/error.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <fmt/format.h>
#include <limits>
#include <type_traits>

namespace rapport {
namespace {

/// Elements that an accessor may have although no buffer holds that much.
constexpr size_t kMostZeros = size_t{1} << 16;

size_t component_size(int component_type) {
    return static_cast<size_t>(
        tinygltf::GetComponentSizeInBytes(static_cast<uint32_t>(component_type)));
}

template <class T> double read_as(const unsigned char* from, bool normalized) {
    T value;
    std::memcpy(&value, from, sizeof value);
    if (normalized && std::is_integral_v<T>)
        return std::max(double(value) / double(std::numeric_limits<T>::max()), -1.0);
    return double(value);
}

double read_component(const unsigned char* from, int component_type, bool normalized) {
    switch (component_type) {
    case TINYGLTF_COMPONENT_TYPE_BYTE:
        return read_as<int8_t>(from, normalized);
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
        return read_as<uint8_t>(from, normalized);
    case TINYGLTF_COMPONENT_TYPE_SHORT:
        return read_as<int16_t>(from, normalized);
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
        return read_as<uint16_t>(from, normalized);
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT:
        return read_as<uint32_t>(from, normalized);
    default:
        return read_as<float>(from, normalized);
    }
}

bool is_index_type(int component_type) {
    return component_type == TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE ||
           component_type == TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT ||
           component_type == TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT;
}

} // namespace

/// `count` elements that are known to lie in their buffer.
struct GltfAccessors::View {
    const unsigned char* data;
    size_t stride;
    const unsigned char* element(size_t i) const { return data + i * stride; }
};

GltfAccessors::GltfAccessors(const tinygltf::Model& model, std::string path)
    : model_(model), path_(std::move(path)) {
    for (const tinygltf::Buffer& buffer : model.buffers)
        buffer_bytes_ += buffer.data.size();
}

void GltfAccessors::fail(const std::string& place, const std::string& expected,
                         const std::string& found) const {
    throw FileError(path_, place, expected, found);
}

const tinygltf::Accessor& GltfAccessors::find(int accessor, const std::string& place) const {
    if (accessor < 0 || static_cast<size_t>(accessor) >= model_.accessors.size())
        fail(place, fmt::format("one of {} accessors", model_.accessors.size()),
             fmt::format("accessor {}", accessor));
    const tinygltf::Accessor& found = model_.accessors[static_cast<size_t>(accessor)];
    // Also bounds an accessor without bufferView, whose elements are 0 where no sparse value is.
    const size_t most = buffer_bytes_ + kMostZeros;
    if (found.count == 0 || found.count > most)
        fail(place,
             fmt::format("from 1 to {} elements in buffers of {} bytes", most, buffer_bytes_),
             fmt::format("accessor {} of {}", accessor, found.count));
    return found;
}

std::span<const unsigned char> GltfAccessors::bytes(int buffer_view,
                                                    const std::string& place) const {
    if (buffer_view < 0 || static_cast<size_t>(buffer_view) >= model_.bufferViews.size())
        fail(place, fmt::format("one of {} bufferViews", model_.bufferViews.size()),
             fmt::format("bufferView {}", buffer_view));
    const tinygltf::BufferView& view = model_.bufferViews[static_cast<size_t>(buffer_view)];
    if (view.buffer < 0 || static_cast<size_t>(view.buffer) >= model_.buffers.size())
        fail(place, fmt::format("one of {} buffers", model_.buffers.size()),
             fmt::format("buffer {} in bufferView {}", view.buffer, buffer_view));
    const std::vector<unsigned char>& bytes = model_.buffers[static_cast<size_t>(view.buffer)].data;
    if (view.byteOffset > bytes.size() || view.byteLength > bytes.size() - view.byteOffset)
        fail(place,
             fmt::format("bufferView {} inside the {} bytes of its buffer", buffer_view,
                         bytes.size()),
             fmt::format("{} bytes from {}", view.byteLength, view.byteOffset));
    return std::span(bytes).subspan(view.byteOffset, view.byteLength);
}

GltfAccessors::View GltfAccessors::view(int buffer_view, size_t offset, size_t count,
                                        size_t element_size, const std::string& place) const {
    const std::span<const unsigned char> all = bytes(buffer_view, place);
    const size_t byte_stride = model_.bufferViews[static_cast<size_t>(buffer_view)].byteStride;
    const size_t stride = byte_stride == 0 ? element_size : byte_stride;
    if (stride < element_size)
        fail(place, fmt::format("a byteStride of {} or more", element_size),
             fmt::format("{}", stride));
    const size_t room = all.size();
    if (offset > room || element_size > room - offset ||
        (count - 1) > (room - offset - element_size) / stride)
        fail(place,
             fmt::format("{} × {} bytes from {} inside bufferView {}", count, element_size, offset,
                         buffer_view),
             fmt::format("its {} bytes", room));
    return {all.data() + offset, stride};
}

std::vector<uint64_t> GltfAccessors::sparse_indices(const tinygltf::Accessor& accessor,
                                                    const std::string& place) const {
    const auto& sparse = accessor.sparse;
    const auto count = static_cast<size_t>(std::max(sparse.count, 0));
    if (count == 0 || count > accessor.count)
        fail(place, fmt::format("from 1 to {} sparse values", accessor.count),
             fmt::format("{}", sparse.count));
    if (!is_index_type(sparse.indices.componentType))
        fail(place, "unsigned sparse indices",
             fmt::format("component type {}", sparse.indices.componentType));
    const View from =
        view(sparse.indices.bufferView, static_cast<size_t>(sparse.indices.byteOffset), count,
             component_size(sparse.indices.componentType), place);
    std::vector<uint64_t> indices(count);
    for (size_t i = 0; i < count; ++i) {
        indices[i] = static_cast<uint64_t>(
            read_component(from.element(i), sparse.indices.componentType, false));
        if (indices[i] >= accessor.count)
            fail(place, fmt::format("sparse indices below {}", accessor.count),
                 fmt::format("{}", indices[i]));
    }
    return indices;
}

/// Calls `store(element, component, value)`, first for the dense values, then for the sparse ones.
template <class Store>
void GltfAccessors::for_each_component(const tinygltf::Accessor& accessor, const std::string& place,
                                       const Store& store) const {
    const auto components =
        static_cast<size_t>(tinygltf::GetNumComponentsInType(static_cast<uint32_t>(accessor.type)));
    const size_t size = component_size(accessor.componentType);
    const auto store_element = [&](size_t element, const unsigned char* from) {
        for (size_t c = 0; c < components; ++c)
            store(element, c,
                  read_component(from + c * size, accessor.componentType, accessor.normalized));
    };
    if (accessor.bufferView >= 0) {
        const View dense = view(accessor.bufferView, accessor.byteOffset, accessor.count,
                                components * size, place);
        for (size_t i = 0; i < accessor.count; ++i)
            store_element(i, dense.element(i));
    }
    if (accessor.sparse.isSparse) {
        const std::vector<uint64_t> elements = sparse_indices(accessor, place);
        const View values = view(accessor.sparse.values.bufferView,
                                 static_cast<size_t>(accessor.sparse.values.byteOffset),
                                 elements.size(), components * size, place);
        for (size_t i = 0; i < elements.size(); ++i)
            store_element(elements[i], values.element(i));
    }
}

template <glm::length_t N>
std::vector<glm::vec<N, float>> GltfAccessors::vectors(int index, int type,
                                                       const std::string& place) const {
    const tinygltf::Accessor& accessor = find(index, place);
    const int component = accessor.componentType;
    const bool is_float = component == TINYGLTF_COMPONENT_TYPE_FLOAT;
    const bool is_small_integer = component == TINYGLTF_COMPONENT_TYPE_BYTE ||
                                  component == TINYGLTF_COMPONENT_TYPE_SHORT ||
                                  component == TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE ||
                                  component == TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT;
    if (accessor.type != type || !(is_float || is_small_integer))
        fail(place, fmt::format("a VEC{} of floats or of 8 or 16 bit integers", N),
             fmt::format("accessor {} of another type", index));
    std::vector<glm::vec<N, float>> values(accessor.count, glm::vec<N, float>(0));
    for_each_component(accessor, place, [&](size_t element, size_t c, double value) {
        if (!std::isfinite(value))
            fail(place, "finite numbers",
                 fmt::format("{} in element {} of accessor {}", value, element, index));
        values[element][static_cast<glm::length_t>(c)] = static_cast<float>(value);
    });
    return values;
}

std::vector<glm::vec2> GltfAccessors::vec2s(int accessor, const std::string& place) const {
    return vectors<2>(accessor, TINYGLTF_TYPE_VEC2, place);
}

std::vector<glm::vec3> GltfAccessors::vec3s(int accessor, const std::string& place) const {
    return vectors<3>(accessor, TINYGLTF_TYPE_VEC3, place);
}

std::vector<glm::vec4> GltfAccessors::vec4s(int accessor, const std::string& place) const {
    return vectors<4>(accessor, TINYGLTF_TYPE_VEC4, place);
}

std::vector<glm::mat4> GltfAccessors::mat4s(int index, const std::string& place) const {
    const tinygltf::Accessor& accessor = find(index, place);
    if (accessor.type != TINYGLTF_TYPE_MAT4 ||
        accessor.componentType != TINYGLTF_COMPONENT_TYPE_FLOAT)
        fail(place, "a MAT4 of floats", fmt::format("accessor {} of another type", index));
    std::vector<glm::mat4> values(accessor.count, glm::mat4(0));
    for_each_component(accessor, place, [&](size_t element, size_t c, double value) {
        if (!std::isfinite(value))
            fail(place, "finite numbers",
                 fmt::format("{} in element {} of accessor {}", value, element, index));
        values[element][static_cast<int>(c / 4)][static_cast<int>(c % 4)] =
            static_cast<float>(value); // column by column, as GLM has them
    });
    return values;
}

std::vector<uint32_t> GltfAccessors::indices(int index, uint64_t limit,
                                             const std::string& place) const {
    const tinygltf::Accessor& accessor = find(index, place);
    if (accessor.type != TINYGLTF_TYPE_SCALAR || !is_index_type(accessor.componentType) ||
        accessor.normalized)
        fail(place, "a SCALAR of unsigned integers",
             fmt::format("accessor {} of another type", index));
    std::vector<uint32_t> values(accessor.count, 0);
    for_each_component(accessor, place, [&](size_t element, size_t, double value) {
        if (value >= double(limit))
            fail(place, fmt::format("vertices below {}", limit),
                 fmt::format("{} in element {} of accessor {}", value, element, index));
        values[element] = static_cast<uint32_t>(value);
    });
    return values;
}

} // namespace rapport
