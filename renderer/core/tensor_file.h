#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

namespace rapport {

/// A named n-dimensional array of the tensor file container which Mitsuba 3 and pbrt-v4 read.
struct TensorField {
    enum class Type : uint8_t { u8 = 1, i8, u16, i16, u32, i32, u64, i64, f16, f32, f64 };
    Type type = Type::f32;
    std::vector<uint64_t> shape;
    std::vector<std::byte> bytes; ///< little-endian, C order

    uint64_t count() const;
    template <class T>
    static TensorField of(std::vector<uint64_t> shape, const std::vector<T>& values);
    static TensorField text(const std::string& text);
    /// The values as T; throws std::invalid_argument if the stored type differs.
    template <class T> std::vector<T> values() const;
    std::string text() const;
};

using TensorFile = std::map<std::string, TensorField>;

/// Written in name order to a temporary file beside the target, then renamed.
void write_tensor_file(const TensorFile& fields, const std::filesystem::path& path);
/// Checks every size and offset against the file's length before any allocation; overlapping data
/// and unknown versions or types are FileErrors too.
TensorFile read_tensor_file(const std::filesystem::path& path);

} // namespace rapport
