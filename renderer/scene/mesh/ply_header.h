#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace rapport {

enum class PlyType : uint8_t { int8, uint8, int16, uint16, int32, uint32, float32, float64 };

/// Bytes of one value in a binary file.
size_t size_of(PlyType type);

struct PlyProperty {
    std::string name;
    PlyType type;                     ///< of the value, or of a list's members
    std::optional<PlyType> list_size; ///< of the number before a list's members
};

struct PlyElement {
    std::string name;
    uint64_t count;
    std::vector<PlyProperty> properties;
};

enum class PlyFormat { ascii, binary_little_endian, binary_big_endian };

struct PlyHeader {
    PlyFormat format;
    std::vector<PlyElement> elements;
    size_t data_offset; ///< of the first byte after the header
    int data_line;      ///< its line number, from 1
};

/// Parses the header at the front of `file`; `path` is for errors.
PlyHeader parse_ply_header(std::string_view file, const std::filesystem::path& path);

} // namespace rapport
