#include "renderer/core/tensor_file.h"

#include "renderer/core/atomic_file.h"
#include "renderer/core/error.h"
#include "renderer/core/input_file.h"

#include <Imath/half.h>
#include <algorithm>
#include <bit>
#include <cstring>
#include <fmt/format.h>
#include <stdexcept>
#include <string_view>

// Layout, little-endian: "tensor_file\0", version as two bytes (1, 0), u32 number of fields; per
// field u16 length of the name, the name, u16 number of dimensions, u8 type, u64 offset of the
// data from the start of the file, u64 per dimension. Then the data, each field aligned to 8.

namespace rapport {
namespace {

static_assert(std::endian::native == std::endian::little);

constexpr std::string_view kMagic{"tensor_file\0\1\0", 14};
constexpr uint64_t kAlignment = 8;
constexpr uint64_t kPreambleSize = kMagic.size() + sizeof(uint32_t);

using Type = TensorField::Type;
template <class T> constexpr Type kTypeOf{};
template <> constexpr Type kTypeOf<uint8_t> = Type::u8;
template <> constexpr Type kTypeOf<int8_t> = Type::i8;
template <> constexpr Type kTypeOf<uint16_t> = Type::u16;
template <> constexpr Type kTypeOf<int16_t> = Type::i16;
template <> constexpr Type kTypeOf<uint32_t> = Type::u32;
template <> constexpr Type kTypeOf<int32_t> = Type::i32;
template <> constexpr Type kTypeOf<uint64_t> = Type::u64;
template <> constexpr Type kTypeOf<int64_t> = Type::i64;
template <> constexpr Type kTypeOf<Imath::half> = Type::f16;
template <> constexpr Type kTypeOf<float> = Type::f32;
template <> constexpr Type kTypeOf<double> = Type::f64;

uint64_t size_of(Type type) {
    switch (type) {
        using enum TensorField::Type;
    case u8:
    case i8:
        return 1;
    case u16:
    case i16:
    case f16:
        return 2;
    case u32:
    case i32:
    case f32:
        return 4;
    case u64:
    case i64:
    case f64:
        return 8;
    }
    throw std::invalid_argument("unknown tensor field type");
}

uint64_t align(uint64_t offset) { return (offset + kAlignment - 1) / kAlignment * kAlignment; }

/// Bytes that the shape needs, or nothing if they are more than `limit`.
bool bytes_of_shape(const std::vector<uint64_t>& shape, Type type, uint64_t limit,
                    uint64_t& bytes) {
    bytes = size_of(type);
    if (std::ranges::find(shape, 0u) != shape.end()) {
        bytes = 0;
        return true;
    }
    for (const uint64_t extent : shape)
        if (__builtin_mul_overflow(bytes, extent, &bytes))
            return false;
    return bytes <= limit;
}

uint64_t header_size(const TensorFile& fields) {
    uint64_t size = kPreambleSize;
    for (const auto& [name, field] : fields)
        size += 2 + name.size() + 2 + 1 + 8 + 8 * field.shape.size();
    return size;
}

template <class T> void put(std::ostream& stream, T value) {
    stream.write(reinterpret_cast<const char*>(&value), sizeof value);
}

/// Where the data of a field, or the header (no field), lie in a file that is being read.
struct Extent {
    uint64_t offset, size;
    std::string name;
    TensorField* field;
};

/// Reads the header front to back, never past the end of the file.
class HeaderReader {
  public:
    HeaderReader(const std::filesystem::path& path) : path_(path), file_(open_input(path)) {}

    std::string bytes(uint64_t count, const std::string& what) {
        need(count, what);
        std::string result(count, '\0');
        read_at(position_, result.data(), count, what);
        position_ += count;
        return result;
    }
    template <class T> T number(const std::string& what) {
        const std::string raw = bytes(sizeof(T), what);
        T value;
        std::memcpy(&value, raw.data(), sizeof value);
        return value;
    }
    void need(uint64_t count, const std::string& what) const {
        if (count > file_.size - position_)
            throw FileError(path_.string(), fmt::format("byte {}", position_),
                            fmt::format("{} ({} bytes)", what, count),
                            fmt::format("end of file at byte {}", file_.size));
    }
    void read_at(uint64_t offset, char* to, uint64_t count, const std::string& what) {
        file_.stream.seekg(static_cast<std::streamoff>(offset));
        if (!file_.stream.read(to, static_cast<std::streamsize>(count)))
            throw FileError(path_.string(), fmt::format("byte {}", offset), what, "a failed read");
    }
    uint64_t position() const { return position_; }
    uint64_t file_size() const { return file_.size; }

  private:
    std::filesystem::path path_;
    InputFile file_;
    uint64_t position_ = 0;
};

} // namespace

uint64_t TensorField::count() const {
    uint64_t count = 1;
    for (const uint64_t extent : shape)
        count *= extent;
    return count;
}

template <class T>
TensorField TensorField::of(std::vector<uint64_t> shape, const std::vector<T>& values) {
    TensorField field{kTypeOf<T>, std::move(shape), {}};
    if (field.count() != values.size())
        throw std::invalid_argument("tensor field: shape and number of values differ");
    field.bytes.resize(values.size() * sizeof(T));
    if (!values.empty())
        std::memcpy(field.bytes.data(), values.data(), field.bytes.size());
    return field;
}

template <class T> std::vector<T> TensorField::values() const {
    if (type != kTypeOf<T>)
        throw std::invalid_argument("tensor field: read as another type than it holds");
    std::vector<T> values(bytes.size() / sizeof(T));
    if (!values.empty())
        std::memcpy(values.data(), bytes.data(), bytes.size());
    return values;
}

#define RAPPORT_INSTANTIATE(T)                                                                     \
    template TensorField TensorField::of<T>(std::vector<uint64_t>, const std::vector<T>&);         \
    template std::vector<T> TensorField::values<T>() const;
RAPPORT_INSTANTIATE(uint8_t)
RAPPORT_INSTANTIATE(int8_t)
RAPPORT_INSTANTIATE(uint16_t)
RAPPORT_INSTANTIATE(int16_t)
RAPPORT_INSTANTIATE(uint32_t)
RAPPORT_INSTANTIATE(int32_t)
RAPPORT_INSTANTIATE(uint64_t)
RAPPORT_INSTANTIATE(int64_t)
RAPPORT_INSTANTIATE(Imath::half)
RAPPORT_INSTANTIATE(float)
RAPPORT_INSTANTIATE(double)
#undef RAPPORT_INSTANTIATE

TensorField TensorField::text(const std::string& text) {
    return of({text.size()}, std::vector<uint8_t>(text.begin(), text.end()));
}

std::string TensorField::text() const {
    const std::vector<uint8_t> characters = values<uint8_t>();
    return {characters.begin(), characters.end()};
}

void write_tensor_file(const TensorFile& fields, const std::filesystem::path& path) {
    for (const auto& [name, field] : fields) {
        uint64_t bytes = 0;
        if (name.empty() || name.size() > 0xFFFF || field.shape.size() > 0xFFFF ||
            !bytes_of_shape(field.shape, field.type, field.bytes.size(), bytes) ||
            bytes != field.bytes.size())
            throw std::invalid_argument("tensor field \"" + name +
                                        "\": its shape does not fit its data");
    }
    write_stream_atomically(path, [&](std::ofstream& stream) {
        stream.write(kMagic.data(), kMagic.size());
        put(stream, static_cast<uint32_t>(fields.size()));
        uint64_t offset = align(header_size(fields));
        for (const auto& [name, field] : fields) {
            put(stream, static_cast<uint16_t>(name.size()));
            stream.write(name.data(), static_cast<std::streamsize>(name.size()));
            put(stream, static_cast<uint16_t>(field.shape.size()));
            put(stream, field.type);
            put(stream, offset);
            for (const uint64_t extent : field.shape)
                put(stream, extent);
            offset = align(offset + field.bytes.size());
        }
        uint64_t written = header_size(fields);
        for (const auto& [name, field] : fields) {
            constexpr char padding[kAlignment] = {};
            stream.write(padding, static_cast<std::streamsize>(align(written) - written));
            stream.write(reinterpret_cast<const char*>(field.bytes.data()),
                         static_cast<std::streamsize>(field.bytes.size()));
            written = align(written) + field.bytes.size();
        }
    });
}

TensorFile read_tensor_file(const std::filesystem::path& path) {
    HeaderReader reader(path);
    const std::string magic = reader.bytes(kMagic.size(), "the head of a tensor file");
    const size_t name_length = kMagic.size() - 2;
    if (magic.compare(0, name_length, kMagic, 0, name_length) != 0)
        throw FileError(path.string(), "byte 0", "a tensor file", "another kind of file");
    if (magic != kMagic)
        throw FileError(path.string(), fmt::format("byte {}", name_length),
                        "tensor file version 1.0",
                        fmt::format("{}.{}", static_cast<uint8_t>(magic[name_length]),
                                    static_cast<uint8_t>(magic[name_length + 1])));

    TensorFile fields;
    std::vector<Extent> extents;
    const auto field_count = reader.number<uint32_t>("the number of fields");
    for (uint32_t i = 0; i < field_count; ++i) {
        const std::string nth = fmt::format("field {} of {}", i + 1, field_count);
        const uint64_t start = reader.position();
        const auto fail = [&](const std::string& expected, const std::string& found) {
            throw FileError(path.string(), fmt::format("byte {}", start), expected, found);
        };
        const std::string name = reader.bytes(reader.number<uint16_t>(nth), nth);
        const auto dimensions = reader.number<uint16_t>(nth);
        const auto type = reader.number<uint8_t>(nth);
        const auto offset = reader.number<uint64_t>(nth);
        if (type < 1 || type > static_cast<uint8_t>(Type::f64))
            fail(fmt::format("a data type from 1 to 11 for \"{}\"", name), std::to_string(type));

        TensorField field{static_cast<Type>(type), {}, {}};
        reader.need(dimensions * sizeof(uint64_t), nth);
        for (uint16_t d = 0; d < dimensions; ++d)
            field.shape.push_back(reader.number<uint64_t>(nth));
        uint64_t bytes = 0;
        if (offset > reader.file_size() ||
            !bytes_of_shape(field.shape, field.type, reader.file_size() - offset, bytes))
            fail(fmt::format("data of \"{}\" within the file's {} bytes", name, reader.file_size()),
                 fmt::format("shape [{}] at byte {}", fmt::join(field.shape, ", "), offset));
        const auto [entry, is_new] = fields.emplace(name, std::move(field));
        if (!is_new)
            fail("field names that differ", fmt::format("\"{}\" twice", name));
        extents.push_back({offset, bytes, fmt::format("the data of \"{}\"", name), &entry->second});
    }

    // Nothing has been allocated for data yet. Extents that neither overlap each other nor leave
    // the file cannot need more than its length.
    extents.push_back({0, reader.position(), "the header", nullptr});
    std::erase_if(extents, [](const Extent& extent) { return extent.size == 0; });
    std::ranges::sort(extents, {}, &Extent::offset);
    for (size_t i = 1; i < extents.size(); ++i)
        if (extents[i].offset - extents[i - 1].offset < extents[i - 1].size)
            throw FileError(path.string(), fmt::format("byte {}", extents[i].offset),
                            extents[i].name + " apart from all other",
                            "an overlap with " + extents[i - 1].name);
    for (const Extent& extent : extents) {
        if (!extent.field)
            continue;
        extent.field->bytes.resize(extent.size);
        reader.read_at(extent.offset, reinterpret_cast<char*>(extent.field->bytes.data()),
                       extent.size, extent.name);
    }
    return fields;
}

} // namespace rapport
