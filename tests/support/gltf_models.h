#pragma once

#include "renderer/core/error.h"
#include "renderer/scene/gltf/gltf.h"
#include "tests/support/file_bytes.h"
#include "tests/support/gltf_writer.h"
#include "tests/support/temporary_folder.h"

#include <functional>
#include <gtest/gtest.h>

// What tests of the glTF reader share: a unit square, and what reading or refusing says.

namespace rapport::tests {

inline const std::vector<float> kQuadPositions = {0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0};
inline const std::vector<float> kQuadUvs = {0, 1, 1, 1, 1, 0, 0, 0}; // v down: upright in our v up
inline const std::vector<uint16_t> kQuadIndices = {0, 1, 2, 0, 2, 3};

/// A unit square in the plane z = 0, face towards +z, UV = (x, y) once v points up.
inline GltfWriter quad() {
    GltfWriter file;
    const int positions = file.add_array(kQuadPositions, kFloat, "VEC3");
    const int uvs = file.add_array(kQuadUvs, kFloat, "VEC2");
    const int indices = file.add_array(kQuadIndices, kUnsignedShort, "SCALAR");
    file.add_mesh(
        {{"attributes", {{"POSITION", positions}, {"TEXCOORD_0", uvs}}}, {"indices", indices}});
    file.add_node({{"mesh", 0}});
    return file;
}

inline GltfModel read(const std::string& bytes, const std::string& name = "model.glb") {
    const TemporaryFolder folder;
    write_bytes(folder / name, bytes);
    return read_gltf(folder / name);
}

inline FileError refusal(const std::function<void()>& action) {
    try {
        action();
    } catch (const FileError& error) {
        EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos) << error.what();
        return error;
    }
    return FileError("", "", "", "accepted");
}
inline FileError refusal(const GltfWriter& file) {
    return refusal([&] { read(file.glb()); });
}

inline bool mentions(const FileError& error, const std::string& text) {
    return std::string(error.what()).find(text) != std::string::npos;
}

inline bool has_warning(const GltfModel& model, const std::string& text) {
    for (const std::string& warning : model.warnings)
        if (warning.find(text) != std::string::npos)
            return true;
    return false;
}

/// Twice the vector area of a mesh: for flat meshes the face normal times twice the area.
inline glm::vec3 doubled_area(const IndexedMesh& mesh) {
    glm::vec3 sum(0);
    for (const glm::uvec3& t : mesh.position_index)
        sum += glm::cross(mesh.positions[t.y] - mesh.positions[t.x],
                          mesh.positions[t.z] - mesh.positions[t.x]);
    return sum;
}

inline void expect_unit_quad(const GltfModel& model) {
    ASSERT_EQ(model.parts.size(), 1u);
    const IndexedMesh& mesh = model.parts[0].mesh;
    EXPECT_EQ(mesh.positions.size(), 4u);
    ASSERT_EQ(mesh.position_index.size(), 2u);
    EXPECT_EQ(doubled_area(mesh), glm::vec3(0, 0, 2));
    ASSERT_EQ(mesh.uv_index.size(), 2u);
    for (size_t t = 0; t < 2; ++t)
        for (int c = 0; c < 3; ++c)
            EXPECT_EQ(glm::vec2(mesh.positions[mesh.position_index[t][c]]),
                      mesh.uvs[mesh.uv_index[t][c]]);
}

} // namespace rapport::tests
