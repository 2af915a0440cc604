#pragma once

#include "tests/support/file_bytes.h"

#include <cstdint>
#include <cstring>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace rapport::tests {

enum ComponentType {
    kByte = 5120,
    kUnsignedByte,
    kShort,
    kUnsignedShort,
    kUnsignedInt = 5125,
    kFloat
};

template <class T> std::string bytes_of(const std::vector<T>& values) {
    std::string bytes(values.size() * sizeof(T), '\0');
    if (!values.empty())
        std::memcpy(bytes.data(), values.data(), bytes.size());
    return bytes;
}

inline std::string base64(const std::string& bytes) {
    constexpr char kDigits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string text;
    for (size_t i = 0; i < bytes.size(); i += 3) {
        uint32_t group = 0;
        for (size_t k = 0; k < 3; ++k)
            group = group << 8 | (i + k < bytes.size() ? static_cast<uint8_t>(bytes[i + k]) : 0);
        for (size_t k = 0; k < 4; ++k)
            text += i + k <= bytes.size() ? kDigits[group >> (18 - 6 * k) & 63] : '=';
    }
    return text;
}

/// A small glTF with one buffer, built up call by call. `json` may be edited freely.
struct GltfWriter {
    nlohmann::json json = {{"asset", {{"version", "2.0"}}}};
    std::string buffer;

    /// Appends data, aligned to 4 bytes; returns the bufferView.
    int add_view(const std::string& data, int stride = 0) {
        buffer.resize((buffer.size() + 3) / 4 * 4);
        nlohmann::json view = {
            {"buffer", 0}, {"byteOffset", buffer.size()}, {"byteLength", data.size()}};
        if (stride > 0)
            view["byteStride"] = stride;
        buffer += data;
        return add("bufferViews", view);
    }
    int add_accessor(int view, int component, size_t count, const std::string& type,
                     size_t offset = 0, bool normalized = false) {
        nlohmann::json accessor = {{"componentType", component}, {"count", count}, {"type", type}};
        if (view >= 0)
            accessor["bufferView"] = view;
        if (offset > 0)
            accessor["byteOffset"] = offset;
        if (normalized)
            accessor["normalized"] = true;
        return add("accessors", accessor);
    }
    template <class T>
    int add_array(const std::vector<T>& values, int component, const std::string& type,
                  bool normalized = false) {
        const size_t width = type == "SCALAR" ? 1
                             : type == "MAT4" ? 16
                                              : static_cast<size_t>(type.back() - '0');
        return add_accessor(add_view(bytes_of(values)), component, values.size() / width, type, 0,
                            normalized);
    }
    /// A mesh of one primitive.
    int add_mesh(const nlohmann::json& primitive) {
        return add("meshes", {{"primitives", {primitive}}});
    }
    int add_node(const nlohmann::json& node) { return add("nodes", node); }
    int add(const std::string& section, const nlohmann::json& entry) {
        json[section].push_back(entry);
        return static_cast<int>(json[section].size()) - 1;
    }

    /// The file's text or bytes, the buffer as a data URI, as a file of its own, or as a chunk.
    std::string embedded() const {
        return text("data:application/octet-stream;base64," + base64(buffer));
    }
    std::string with_buffer_file(const std::string& name) const { return text(name); }
    std::string glb() const {
        std::string chunk = text("");
        chunk.resize((chunk.size() + 3) / 4 * 4, ' ');
        std::string data = buffer;
        data.resize((data.size() + 3) / 4 * 4);
        const auto word = [](size_t value) {
            const auto bits = static_cast<uint32_t>(value);
            return bytes_of(std::vector<uint32_t>{bits});
        };
        std::string file = word(0x4e4f534a) + chunk; // "JSON"
        file = word(chunk.size()) + file;
        if (!data.empty())
            file += word(data.size()) + word(0x004e4942) + data; // "BIN"
        return word(0x46546c67) + word(2) + word(file.size() + 12) + file;
    }

  private:
    std::string text(const std::string& uri) const {
        nlohmann::json all = json;
        if (!buffer.empty()) {
            all["buffers"] = {{{"byteLength", buffer.size()}}};
            if (!uri.empty())
                all["buffers"][0]["uri"] = uri;
        }
        return all.dump();
    }
};

} // namespace rapport::tests
