#include "renderer/scene/mesh/ply.h"

#include "renderer/core/error.h"
#include "tests/support/file_bytes.h"
#include "tests/support/shared_data.h"
#include "tests/support/temporary_folder.h"

#include <algorithm>
#include <cstring>
#include <functional>
#include <gtest/gtest.h>

namespace rapport {
namespace {

TriangleMesh read(const std::string& bytes) {
    const tests::TemporaryFolder folder;
    tests::write_bytes(folder / "mesh.ply", bytes);
    return read_ply(folder / "mesh.ply");
}

FileError refusal(const std::string& bytes) {
    try {
        read(bytes);
    } catch (const FileError& error) {
        return error;
    }
    return FileError("", "", "", "accepted");
}

std::string header(const std::string& format, int vertices, int faces) {
    return "ply\nformat " + format + " 1.0\ncomment a test\nelement vertex " +
           std::to_string(vertices) +
           "\nproperty float x\nproperty double y\nproperty float z\nproperty uchar red\n"
           "property float s\nproperty float t\nelement face " +
           std::to_string(faces) +
           "\nproperty short flag\nproperty list uchar int vertex_indices\nend_header\n";
}

/// Appends a value in the asked byte order.
template <class T> void put(std::string& bytes, T value, bool big_endian) {
    char raw[sizeof(T)];
    std::memcpy(raw, &value, sizeof(T));
    if (big_endian)
        std::reverse(raw, raw + sizeof(T));
    bytes.append(raw, sizeof(T));
}

/// A unit square in z = 0 as a quad and, beside it, a triangle; UV = (x, y).
std::string binary(bool big_endian) {
    std::string bytes = header(big_endian ? "binary_big_endian" : "binary_little_endian", 5, 2);
    for (const auto& [x, y] : {std::pair{0, 0}, {1, 0}, {1, 1}, {0, 1}, {2, 0}}) {
        put(bytes, float(x), big_endian);
        put(bytes, double(y), big_endian);
        put(bytes, 0.0f, big_endian);
        put(bytes, uint8_t{200}, big_endian);
        put(bytes, float(x), big_endian);
        put(bytes, float(y), big_endian);
    }
    for (const auto& face : std::vector<std::vector<int32_t>>{{0, 1, 2, 3}, {1, 4, 2}}) {
        put(bytes, int16_t{-1}, big_endian);
        put(bytes, static_cast<uint8_t>(face.size()), big_endian);
        for (const int32_t corner : face)
            put(bytes, corner, big_endian);
    }
    return bytes;
}

const std::string kAscii = header("ascii", 5, 2) + "0 0 0 200 0 0\n1 0 0 200 1 0\n1 1 0 200 1 1\n"
                                                   "0 1 0 200 0 1\n2 0 0 200 2 0\n"
                                                   "-1 4 0 1 2 3\n-1 3 1 4 2\n";

void expect_square_and_triangle(const TriangleMesh& mesh) {
    ASSERT_EQ(mesh.positions.size(), 5u);
    EXPECT_EQ(mesh.positions[2], glm::vec3(1, 1, 0));
    EXPECT_EQ(mesh.triangles, (std::vector<glm::uvec3>{{0, 1, 2}, {0, 2, 3}, {1, 4, 2}}));
    EXPECT_EQ(mesh.uvs[4], glm::vec2(2, 0));
    EXPECT_TRUE(mesh.normals.empty());
    for (size_t v = 0; v < 5; ++v) {
        EXPECT_LT(glm::distance(mesh.weft[v], glm::vec3(1, 0, 0)), 1e-6f);
        EXPECT_LT(glm::distance(mesh.warp[v], glm::vec3(0, 1, 0)), 1e-6f);
    }
}

TEST(Ply, ReadsTextAndBothByteOrders) {
    expect_square_and_triangle(read(kAscii));
    expect_square_and_triangle(read(binary(false)));
    expect_square_and_triangle(read(binary(true)));
    std::string dos = kAscii;
    for (size_t at = 0; (at = dos.find('\n', at)) != std::string::npos; at += 2)
        dos.replace(at, 1, "\r\n");
    expect_square_and_triangle(read(dos));
}

TEST(Ply, QuadsAreCutAlongTheShorterDiagonal) {
    const std::string kite = "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\n"
                             "property float y\nproperty float z\nelement face 1\n"
                             "property list uchar uint vertex_index\nend_header\n"
                             "-3 0 0\n0 -1 0\n3 0 0\n0 1 0\n4 0 1 2 3\n";
    EXPECT_EQ(read(kite).triangles, (std::vector<glm::uvec3>{{0, 1, 3}, {1, 2, 3}}));
}

TEST(Ply, NormalsAreMadeUnitAndFacesMayComeFirst) {
    const std::string file = "ply\nformat ascii 1.0\nelement face 1\n"
                             "property list uchar int vertex_indices\nelement vertex 3\n"
                             "property float x\nproperty float y\nproperty float z\n"
                             "property float nx\nproperty float ny\nproperty float nz\n"
                             "end_header\n3 0 1 2\n0 0 0 0 0 2\n1 0 0 0 0 0\n0 1 0 0 3 4\n";
    const TriangleMesh mesh = read(file);
    EXPECT_EQ(mesh.normals[0], glm::vec3(0, 0, 1));
    EXPECT_EQ(mesh.normals[1], glm::vec3(0, 0, 1)); // none in the file: from the triangles
    EXPECT_EQ(mesh.normals[2], glm::vec3(0, 0.6f, 0.8f));
    EXPECT_TRUE(mesh.uvs.empty());
    EXPECT_TRUE(mesh.warp.empty());
}

TEST(Ply, TruncationIsRefusedEverywhere) {
    for (const std::string& file : {binary(false), kAscii})
        for (size_t length = 0; length + 2 < file.size(); length += 3)
            EXPECT_NE(refusal(file.substr(0, length)).found, "accepted") << length;
}

TEST(Ply, DamageIsNamed) {
    const auto replaced = [](const std::string& from, const std::string& to) {
        std::string file = kAscii;
        const size_t at = file.find(from);
        EXPECT_NE(at, std::string::npos) << from;
        return refusal(file.replace(at, from.size(), to));
    };
    EXPECT_EQ(replaced("ply", "pla").place, "1");
    EXPECT_EQ(replaced("ascii", "text").place, "2");
    EXPECT_EQ(replaced("float x", "real x").place, "5");
    EXPECT_EQ(replaced("float x", "float w").found, "not all of them");
    EXPECT_EQ(replaced("vertex_indices", "corners").found, "none");
    EXPECT_NE(replaced("vertex 5", "vertex 99999999999").found, "accepted");
    EXPECT_NE(replaced("vertex 5", "vertex -5").found, "accepted");
    EXPECT_EQ(replaced("1 1 0 200", "1 nan 0 200").found, "nan as y of vertex 2");
    EXPECT_EQ(replaced("1 1 0 200", "1 1x 0 200").found, "'1x'");
    EXPECT_EQ(replaced("1 1 0 200", "1 1x 0 200").place, "17");
    EXPECT_NE(replaced("1 1 0 200", "1 1 1e99 200").found, "accepted");
    EXPECT_EQ(replaced("3 1 4 2", "3 1 5 2").found, "a face with vertex 5");
    EXPECT_NE(replaced("3 1 4 2", "3 1 -4 2").found, "accepted");
    EXPECT_EQ(replaced("3 1 4 2", "2 1 4").found, "2");
    EXPECT_NE(replaced("3 1 4 2", "99999 1 4").found, "accepted");
}

TEST(Ply, SharedSheet) {
    RAPPORT_SHARED_DATA_OR_SKIP(data);
    const TriangleMesh mesh = read_ply(data / "../bench/cloth200k.ply");
    EXPECT_EQ(mesh.positions.size(), 100489u);
    EXPECT_EQ(mesh.triangles.size(), 199712u);
    EXPECT_EQ(mesh.normals.size(), mesh.positions.size());
    EXPECT_EQ(mesh.warp.size(), mesh.positions.size());
}

} // namespace
} // namespace rapport
