#include "renderer/scene/mesh/ply.h"

#include "renderer/core/error.h"
#include "renderer/scene/file_bytes.h"
#include "renderer/scene/mesh/ply_header.h"
#include "renderer/scene/mesh/surface_frames.h"

#include <algorithm>
#include <array>
#include <bit>
#include <charconv>
#include <cstring>
#include <fmt/format.h>

namespace rapport {
namespace {

/// Reads one value after the other, from text or from bytes; every read is checked.
class ValueReader {
  public:
    ValueReader(std::string_view file, const PlyHeader& header, std::string path)
        : file_(file), format_(header.format), position_(header.data_offset),
          line_(header.data_line), path_(std::move(path)) {}

    double read(PlyType type) {
        if (format_ == PlyFormat::ascii)
            return read_text();
        switch (type) {
        case PlyType::int8:
            return read_bytes<int8_t>();
        case PlyType::uint8:
            return read_bytes<uint8_t>();
        case PlyType::int16:
            return read_bytes<int16_t>();
        case PlyType::uint16:
            return read_bytes<uint16_t>();
        case PlyType::int32:
            return read_bytes<int32_t>();
        case PlyType::uint32:
            return read_bytes<uint32_t>();
        case PlyType::float32:
            return read_bytes<float>();
        case PlyType::float64:
            break;
        }
        return read_bytes<double>();
    }

    /// The bytes from here to the end, each value needing at least one.
    size_t remaining() const { return file_.size() - position_; }

    std::string place() const {
        return format_ == PlyFormat::ascii ? std::to_string(line_)
                                           : fmt::format("byte {}", position_);
    }
    [[noreturn]] void fail(const std::string& expected, const std::string& found) const {
        throw FileError(path_, place(), expected, found);
    }

  private:
    template <class T> T read_bytes() {
        std::array<char, sizeof(T)> bytes;
        if (remaining() < sizeof(T))
            fail("more data", "the end of the file");
        std::memcpy(bytes.data(), file_.data() + position_, sizeof(T));
        position_ += sizeof(T);
        constexpr bool native_is_big = std::endian::native == std::endian::big;
        if ((format_ == PlyFormat::binary_big_endian) != native_is_big)
            std::reverse(bytes.begin(), bytes.end());
        return std::bit_cast<T>(bytes);
    }

    double read_text() {
        while (position_ < file_.size() && std::strchr(" \t\r\n", file_[position_])) {
            line_ += file_[position_] == '\n';
            ++position_;
        }
        if (position_ == file_.size())
            fail("more data", "the end of the file");
        double value = 0;
        const char* begin = file_.data() + position_;
        const char* end = file_.data() + file_.size();
        const auto [stop, error] = std::from_chars(begin, end, value);
        if (error != std::errc() || (stop != end && !std::strchr(" \t\r\n", *stop))) {
            const size_t length =
                std::min<size_t>(file_.find_first_of(" \t\r\n", position_) - position_, 20);
            fail("a number", fmt::format("'{}'", file_.substr(position_, length)));
        }
        position_ = static_cast<size_t>(stop - file_.data());
        return value;
    }

    std::string_view file_;
    PlyFormat format_;
    size_t position_;
    int line_;
    std::string path_;
};

size_t read_list_size(ValueReader& reader, const PlyProperty& property) {
    const double size = reader.read(*property.list_size);
    if (!(size >= 0 && size <= double(reader.remaining())) || size != std::floor(size))
        reader.fail("a list that the file has room for", fmt::format("{} members", size));
    return static_cast<size_t>(size);
}

void skip(ValueReader& reader, const PlyProperty& property) {
    const size_t count = property.list_size ? read_list_size(reader, property) : 1;
    for (size_t i = 0; i < count; ++i)
        reader.read(property.type);
}

/// Reads the file's elements into a mesh.
class MeshReader {
  public:
    MeshReader(std::string_view file, const PlyHeader& header, const std::string& path)
        : header_(header), reader_(file, header, path), path_(path) {}

    TriangleMesh run() {
        for (const PlyElement& element : header_.elements) {
            // Each takes a byte at least, so that a count cannot ask for too much memory or time.
            if (element.properties.empty())
                throw FileError(path_, "", "properties of element " + element.name, "none");
            if (element.count > reader_.remaining())
                reader_.fail(fmt::format("{} × element {}", element.count, element.name),
                             fmt::format("{} bytes", reader_.remaining()));
            if (element.name == "vertex")
                read_vertices(element);
            else if (element.name == "face")
                read_faces(element);
            else
                for (uint64_t i = 0; i < element.count; ++i)
                    for (const PlyProperty& property : element.properties)
                        skip(reader_, property);
        }
        if (faces_.empty())
            throw FileError(path_, "", "vertices and faces", "none");
        for (const glm::uvec4& face : faces_)
            add_face(face);
        if (std::find(mesh_.normals.begin(), mesh_.normals.end(), glm::vec3(0)) !=
            mesh_.normals.end())
            replace_zero_normals();
        if (!mesh_.uvs.empty())
            add_frames(mesh_);
        return std::move(mesh_);
    }

  private:
    void read_vertices(const PlyElement& element) {
        // Which of the eight coordinates each property is.
        constexpr std::array<std::array<std::string_view, 4>, 8> kNames = {
            {{"x"},
             {"y"},
             {"z"},
             {"nx"},
             {"ny"},
             {"nz"},
             {"u", "s", "texture_u", "texture_s"},
             {"v", "t", "texture_v", "texture_t"}}};
        constexpr size_t kOther = kNames.size();
        std::vector<size_t> slots;
        std::array<bool, kOther + 1> present{};
        for (const PlyProperty& property : element.properties) {
            size_t slot = 0;
            while (slot < kOther &&
                   (property.list_size || std::find(kNames[slot].begin(), kNames[slot].end(),
                                                    property.name) == kNames[slot].end()))
                ++slot;
            slots.push_back(slot);
            present[slot] = true;
        }
        if (!present[0] || !present[1] || !present[2])
            throw FileError(path_, "", "vertex properties x, y and z", "not all of them");
        const bool has_normals = present[3] && present[4] && present[5];
        const bool has_uvs = present[6] && present[7];
        mesh_.positions.reserve(element.count);
        mesh_.normals.reserve(has_normals ? element.count : 0);
        mesh_.uvs.reserve(has_uvs ? element.count : 0);
        for (uint64_t i = 0; i < element.count; ++i) {
            std::array<float, kOther + 1> value{};
            for (size_t p = 0; p < slots.size(); ++p) {
                if (slots[p] == kOther) {
                    skip(reader_, element.properties[p]);
                    continue;
                }
                value[slots[p]] = static_cast<float>(reader_.read(element.properties[p].type));
                if (!std::isfinite(value[slots[p]]))
                    reader_.fail("a finite number",
                                 fmt::format("{} as {} of vertex {}", value[slots[p]],
                                             element.properties[p].name, i));
            }
            mesh_.positions.emplace_back(value[0], value[1], value[2]);
            if (has_normals) {
                const glm::vec3 normal(value[3], value[4], value[5]);
                const float length = glm::length(normal);
                mesh_.normals.push_back(length > 0 ? normal / length : glm::vec3(0));
            }
            if (has_uvs)
                mesh_.uvs.emplace_back(value[6], value[7]);
        }
    }

    void read_faces(const PlyElement& element) {
        const auto is_corners = [](const PlyProperty& p) {
            return p.list_size && (p.name == "vertex_indices" || p.name == "vertex_index");
        };
        if (std::none_of(element.properties.begin(), element.properties.end(), is_corners))
            throw FileError(path_, "", "a face property list vertex_indices", "none");
        faces_.reserve(element.count);
        for (uint64_t i = 0; i < element.count; ++i)
            for (const PlyProperty& property : element.properties) {
                if (!is_corners(property)) {
                    skip(reader_, property);
                    continue;
                }
                const size_t count = read_list_size(reader_, property);
                if (count != 3 && count != 4)
                    reader_.fail("faces of 3 or 4 corners", fmt::format("{}", count));
                glm::uvec4 corner(kNoCorner);
                for (size_t c = 0; c < count; ++c) {
                    const double index = reader_.read(property.type);
                    if (!(index >= 0 && index < kNoCorner) || index != std::floor(index))
                        reader_.fail("the index of a vertex", fmt::format("{}", index));
                    corner[static_cast<int>(c)] = static_cast<uint32_t>(index);
                }
                faces_.push_back(corner);
            }
    }

    void add_face(const glm::uvec4& corner) {
        const auto& p = mesh_.positions;
        for (int c = 0; c < 4; ++c)
            if (corner[c] >= p.size() && (c < 3 || corner[c] != kNoCorner))
                throw FileError(path_, "", fmt::format("vertices below {}", p.size()),
                                fmt::format("a face with vertex {}", corner[c]));
        const glm::uvec3 triangle(corner);
        if (corner.w == kNoCorner) {
            mesh_.triangles.push_back(triangle);
        } else if (glm::distance(p[corner.x], p[corner.z]) <=
                   glm::distance(p[corner.y], p[corner.w])) {
            mesh_.triangles.push_back(triangle);
            mesh_.triangles.emplace_back(corner.x, corner.z, corner.w);
        } else {
            mesh_.triangles.emplace_back(corner.x, corner.y, corner.w);
            mesh_.triangles.emplace_back(corner.y, corner.z, corner.w);
        }
    }

    void replace_zero_normals() {
        const std::vector<glm::vec3> smooth = smooth_normals(mesh_.positions, mesh_.triangles);
        for (size_t v = 0; v < smooth.size(); ++v)
            if (mesh_.normals[v] == glm::vec3(0))
                mesh_.normals[v] = smooth[v];
    }

    static constexpr uint32_t kNoCorner = 0xffffffff; ///< fourth corner of a triangle

    const PlyHeader& header_;
    ValueReader reader_;
    std::string path_;
    TriangleMesh mesh_;
    std::vector<glm::uvec4> faces_; ///< as in the file, which may name vertices that follow later
};

} // namespace

TriangleMesh read_ply(const std::filesystem::path& path) {
    const std::vector<char> file = read_file(path);
    const std::string_view text(file.data(), file.size());
    const PlyHeader header = parse_ply_header(text, path);
    return MeshReader(text, header, path.string()).run();
}

} // namespace rapport
