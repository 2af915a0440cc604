#include "renderer/scene/gltf.h"

#include "renderer/core/error.h"
#include "tests/support/file_bytes.h"
#include "tests/support/gltf_writer.h"
#include "tests/support/shared_data.h"
#include "tests/support/temporary_folder.h"

#include <cmath>
#include <functional>
#include <gtest/gtest.h>
#include <limits>

namespace rapport {
namespace {

using nlohmann::json;
using tests::GltfWriter;

const std::vector<float> kQuadPositions = {0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0};
const std::vector<float> kQuadUvs = {0, 1, 1, 1, 1, 0, 0, 0}; // v down: upright in our v up
const std::vector<uint16_t> kQuadIndices = {0, 1, 2, 0, 2, 3};

/// A unit square in the plane z = 0, face towards +z, UV = (x, y) once v points up.
GltfWriter quad() {
    GltfWriter file;
    const int positions = file.add_array(kQuadPositions, tests::kFloat, "VEC3");
    const int uvs = file.add_array(kQuadUvs, tests::kFloat, "VEC2");
    const int indices = file.add_array(kQuadIndices, tests::kUnsignedShort, "SCALAR");
    file.add_mesh(
        {{"attributes", {{"POSITION", positions}, {"TEXCOORD_0", uvs}}}, {"indices", indices}});
    file.add_node({{"mesh", 0}});
    return file;
}

GltfModel read(const std::string& bytes, const std::string& name = "model.glb") {
    const tests::TemporaryFolder folder;
    tests::write_bytes(folder / name, bytes);
    return read_gltf(folder / name);
}

FileError refusal(const std::function<void()>& action) {
    try {
        action();
    } catch (const FileError& error) {
        EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos) << error.what();
        return error;
    }
    return FileError("", "", "", "accepted");
}
FileError refusal(const GltfWriter& file) {
    return refusal([&] { read(file.glb()); });
}

bool mentions(const FileError& error, const std::string& text) {
    return std::string(error.what()).find(text) != std::string::npos;
}

bool has_warning(const GltfModel& model, const std::string& text) {
    for (const std::string& warning : model.warnings)
        if (warning.find(text) != std::string::npos)
            return true;
    return false;
}

/// Twice the vector area of a mesh: for flat meshes the face normal times twice the area.
glm::vec3 doubled_area(const IndexedMesh& mesh) {
    glm::vec3 sum(0);
    for (const glm::uvec3& t : mesh.position_index)
        sum += glm::cross(mesh.positions[t.y] - mesh.positions[t.x],
                          mesh.positions[t.z] - mesh.positions[t.x]);
    return sum;
}

void expect_unit_quad(const GltfModel& model) {
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

TEST(Gltf, ReadsAllThreeContainers) {
    const GltfWriter file = quad();
    expect_unit_quad(read(file.glb()));
    expect_unit_quad(read(file.embedded(), "model.gltf"));
    const tests::TemporaryFolder folder;
    tests::write_bytes(folder / "model.gltf", file.with_buffer_file("a%20buffer.bin"));
    tests::write_bytes(folder / "a buffer.bin", file.buffer);
    expect_unit_quad(read_gltf(folder / "model.gltf"));
}

TEST(Gltf, MissingOrShortBufferFileIsRefused) {
    const GltfWriter file = quad();
    const tests::TemporaryFolder folder;
    tests::write_bytes(folder / "model.gltf", file.with_buffer_file("data.bin"));
    EXPECT_TRUE(mentions(refusal([&] { read_gltf(folder / "model.gltf"); }), "data.bin"));
    tests::write_bytes(folder / "data.bin", file.buffer.substr(1));
    EXPECT_FALSE(mentions(refusal([&] { read_gltf(folder / "model.gltf"); }), "accepted"));
    EXPECT_FALSE(mentions(refusal([&] { read_gltf(folder / "none.glb"); }), "accepted"));
    EXPECT_FALSE(mentions(refusal([&] { read_gltf(folder.path()); }), "accepted"));
}

TEST(Gltf, NodeTransformsCompose) {
    GltfWriter file = quad();
    file.json["nodes"] = {
        {{"children", {1}}, {"translation", {10, 0, 0}}, {"scale", {2, 2, 2}}},
        // Column-major: a quarter turn about z, then one along y.
        {{"mesh", 0}, {"matrix", {0, 1, 0, 0, -1, 0, 0, 0, 0, 0, 1, 0, 0, 1, 0, 1}}}};
    const GltfModel model = read(file.glb());
    ASSERT_EQ(model.parts.size(), 1u);
    // (1, 0, 0) → (0, 1, 0) + (0, 1, 0) → (0, 4, 0) + (10, 0, 0)
    EXPECT_EQ(model.parts[0].mesh.positions[1], glm::vec3(10, 4, 0));
    EXPECT_EQ(doubled_area(model.parts[0].mesh), glm::vec3(0, 0, 8));
    EXPECT_TRUE(model.warnings.empty());
}

TEST(Gltf, RotationIsAQuaternionXyzw) {
    GltfWriter file = quad();
    const double half = std::sqrt(0.5);
    file.json["nodes"][0]["rotation"] = {0, 0, half, half}; // a quarter turn about z
    const glm::vec3 p = read(file.glb()).parts[0].mesh.positions[1];
    EXPECT_NEAR(p.x, 0, 1e-7);
    EXPECT_NEAR(p.y, 1, 1e-7);
}

TEST(Gltf, MirroredNodeKeepsTheFaceSide) {
    GltfWriter file = quad();
    file.json["nodes"][0]["scale"] = {-1, 1, 1};
    const GltfModel model = read(file.glb());
    EXPECT_EQ(doubled_area(model.parts[0].mesh), glm::vec3(0, 0, 2));
    EXPECT_TRUE(has_warning(model, "nodes[0]: mirrored"));
    file.json["nodes"][0]["scale"] = {-1, -1, 1}; // a half turn
    EXPECT_FALSE(has_warning(read(file.glb()), "mirrored"));
}

TEST(Gltf, OneMeshShownByManyNodes) {
    GltfWriter file = quad();
    file.add_node({{"mesh", 0}, {"translation", {0, 0, 5}}});
    const GltfModel model = read(file.glb());
    ASSERT_EQ(model.parts.size(), 2u);
    EXPECT_EQ(model.parts[1].mesh.positions[0], glm::vec3(0, 0, 5));
}

TEST(Gltf, SceneDecidesWhatIsShown) {
    GltfWriter file = quad();
    file.add_node({{"mesh", 0}, {"translation", {0, 0, 5}}});
    file.json["scenes"] = {{{"nodes", {1}}}, {{"nodes", {0}}}};
    EXPECT_EQ(read(file.glb()).parts.at(0).mesh.positions[0].z, 5); // no key: scene 0
    file.json["scene"] = 1;
    EXPECT_EQ(read(file.glb()).parts.at(0).mesh.positions[0].z, 0);
    file.json["scene"] = 2;
    EXPECT_EQ(refusal(file).place, "scene");
}

TEST(Gltf, CyclesAndSharedNodesAreRefused) {
    GltfWriter file = quad();
    file.json["nodes"] = {{{"children", {1}}}, {{"children", {0}}, {"mesh", 0}}};
    EXPECT_TRUE(mentions(refusal(file), "cycle"));
    file.json["scenes"] = {{{"nodes", {0}}}};
    EXPECT_TRUE(mentions(refusal(file), "reached twice"));
    file.json["nodes"][1] = {{"children", {7}}};
    EXPECT_TRUE(mentions(refusal(file), "nodes[7]"));
}

TEST(Gltf, LongChainsOfNodesDoNotExhaustTheStack) {
    GltfWriter file = quad();
    const int count = 20000;
    for (int i = 1; i <= count; ++i)
        file.add_node({{"children", {i - 1}}});
    EXPECT_EQ(read(file.glb()).parts.size(), 1u);
}

TEST(Gltf, StripsAndFansAndUnindexedTriangles) {
    GltfWriter file = quad();
    json& primitive = file.json["meshes"][0]["primitives"][0];
    primitive["mode"] = 6; // fan over the corners in order
    primitive["indices"] =
        file.add_array(std::vector<uint8_t>{0, 1, 2, 3}, tests::kUnsignedByte, "SCALAR");
    expect_unit_quad(read(file.glb()));
    primitive["mode"] = 5; // strip
    primitive["indices"] =
        file.add_array(std::vector<uint32_t>{0, 1, 3, 2}, tests::kUnsignedInt, "SCALAR");
    expect_unit_quad(read(file.glb()));

    GltfWriter soup;
    std::vector<float> positions;
    for (const uint16_t i : kQuadIndices)
        for (size_t k = 0; k < 3; ++k)
            positions.push_back(kQuadPositions[3 * i + k]);
    soup.add_mesh(
        {{"attributes", {{"POSITION", soup.add_array(positions, tests::kFloat, "VEC3")}}}});
    soup.add_node({{"mesh", 0}});
    const IndexedMesh mesh = read(soup.glb()).parts.at(0).mesh;
    EXPECT_EQ(mesh.positions.size(), 4u); // merged by value
    EXPECT_EQ(doubled_area(mesh), glm::vec3(0, 0, 2));
    EXPECT_TRUE(mesh.uv_index.empty());
}

TEST(Gltf, PointsAndLinesAreIgnoredWithAWarning) {
    GltfWriter file = quad();
    json lines = file.json["meshes"][0]["primitives"][0];
    lines["mode"] = 1;
    file.json["meshes"][0]["primitives"].push_back(lines);
    const GltfModel model = read(file.glb());
    EXPECT_EQ(model.parts.size(), 1u);
    EXPECT_TRUE(has_warning(model, "meshes[0].primitives[1]: points and lines"));
}

TEST(Gltf, QuantisedIntegers) {
    GltfWriter file = quad();
    file.json["extensionsRequired"] = {"KHR_mesh_quantization"};
    json& attributes = file.json["meshes"][0]["primitives"][0]["attributes"];
    // Each vertex padded to 8 bytes, as the extension wants it.
    const std::vector<int16_t> raw = {0, 0, 0, 0, 1, 0, 0, 0, 1, 1, 0, 0, 0, 1, 0, 0};
    attributes["POSITION"] =
        file.add_accessor(file.add_view(tests::bytes_of(raw), 8), tests::kShort, 4, "VEC3");
    attributes["TEXCOORD_0"] =
        file.add_array(std::vector<uint16_t>{0, 65535, 65535, 65535, 65535, 0, 0, 0},
                       tests::kUnsignedShort, "VEC2", true);
    expect_unit_quad(read(file.glb()));

    const std::vector<int8_t> signed_bytes = {0,   0,   0, 0, 127, 0,   0, 0,
                                              127, 127, 0, 0, 0,   127, 0, 0};
    attributes["POSITION"] = file.add_accessor(file.add_view(tests::bytes_of(signed_bytes), 4),
                                               tests::kByte, 4, "VEC3", 0, true);
    attributes["TEXCOORD_0"] = file.add_accessor(
        file.add_view(tests::bytes_of(std::vector<uint8_t>{0, 255, 9, 9, 255, 255, 9, 9, 255, 0, 9,
                                                           9, 0, 0, 9, 9}),
                      4),
        tests::kUnsignedByte, 4, "VEC2", 0, true);
    expect_unit_quad(read(file.glb()));
}

TEST(Gltf, InterleavedAttributes) {
    GltfWriter file = quad();
    std::vector<float> vertices;
    for (size_t v = 0; v < 4; ++v) {
        vertices.insert(vertices.end(), kQuadPositions.begin() + 3 * v,
                        kQuadPositions.begin() + 3 * v + 3);
        vertices.insert(vertices.end(), kQuadUvs.begin() + 2 * v, kQuadUvs.begin() + 2 * v + 2);
    }
    const int view = file.add_view(tests::bytes_of(vertices), 20);
    json& attributes = file.json["meshes"][0]["primitives"][0]["attributes"];
    attributes["POSITION"] = file.add_accessor(view, tests::kFloat, 4, "VEC3");
    attributes["TEXCOORD_0"] = file.add_accessor(view, tests::kFloat, 4, "VEC2", 12);
    expect_unit_quad(read(file.glb()));
}

TEST(Gltf, SparseAccessors) {
    GltfWriter file = quad();
    std::vector<float> wrong = kQuadPositions;
    wrong[7] = 99; // y of vertex 2
    const int dense = file.add_array(wrong, tests::kFloat, "VEC3");
    const int indices = file.add_view(tests::bytes_of(std::vector<uint16_t>{2}));
    const int values = file.add_view(tests::bytes_of(std::vector<float>{1, 1, 0}));
    json& sparse = file.json["accessors"][static_cast<size_t>(dense)]["sparse"];
    sparse = {{"count", 1},
              {"indices", {{"bufferView", indices}, {"componentType", tests::kUnsignedShort}}},
              {"values", {{"bufferView", values}}}};
    file.json["meshes"][0]["primitives"][0]["attributes"]["POSITION"] = dense;
    expect_unit_quad(read(file.glb()));
    sparse["indices"]["componentType"] = tests::kUnsignedInt; // reads past the 2 bytes
    EXPECT_EQ(refusal(file).place, "meshes[0].primitives[0].attributes.POSITION");
    sparse["indices"]["componentType"] = tests::kUnsignedByte;
    sparse["indices"]["byteOffset"] = 1; // the upper byte: index 0, so vertex 0 moves
    EXPECT_NE(doubled_area(read(file.glb()).parts.at(0).mesh), glm::vec3(0, 0, 2));
    sparse["count"] = 5;
    EXPECT_TRUE(mentions(refusal(file), "sparse"));
}

TEST(Gltf, TextureTransformComesBeforeTheFlip) {
    GltfWriter file = quad();
    file.json["extensionsRequired"] = {"KHR_texture_transform"};
    file.json["materials"] = {
        {{"name", "Body"},
         {"pbrMetallicRoughness",
          {{"baseColorTexture",
            {{"index", 0},
             {"extensions",
              {{"KHR_texture_transform",
                {{"offset", {0, 1}}, {"rotation", kPi / 2}, {"scale", {0.5, 0.5}}}}}}}}}}}};
    json& primitive = file.json["meshes"][0]["primitives"][0];
    primitive["material"] = 0;
    const GltfModel model = read(file.glb());
    EXPECT_EQ(model.parts.at(0).material, "Body");
    // The example of the extension's text: the lower left quadrant of the picture, turned by 90°.
    // glTF's (u, v) becomes (v, −u)/2 + (0, 1) with v down; our v is 1 minus that.
    const IndexedMesh& mesh = model.parts[0].mesh;
    for (size_t t = 0; t < 2; ++t)
        for (int c = 0; c < 3; ++c) {
            const glm::vec3 p = mesh.positions[mesh.position_index[t][c]];
            const float u = p.x, v = 1 - p.y; // as written in the file
            const glm::vec2 uv = mesh.uvs[mesh.uv_index[t][c]];
            EXPECT_NEAR(uv.x, v / 2, 1e-6);
            EXPECT_NEAR(uv.y, 1 - (1 - u / 2), 1e-6);
        }
    // Meant for another set of coordinates: ours stay.
    json& texture = file.json["materials"][0]["pbrMetallicRoughness"]["baseColorTexture"];
    texture["extensions"]["KHR_texture_transform"]["texCoord"] = 1;
    expect_unit_quad(read(file.glb()));
    texture["extensions"]["KHR_texture_transform"] = {{"scale", {1, 2, 3}}};
    EXPECT_TRUE(mentions(refusal(file), "KHR_texture_transform.scale"));
}

TEST(Gltf, RequiredExtensions) {
    GltfWriter file = quad();
    for (const std::string name :
         {"KHR_draco_mesh_compression", "EXT_meshopt_compression", "EXT_something_new"}) {
        file.json["extensionsRequired"] = {name};
        EXPECT_TRUE(mentions(refusal(file), "not supported: " + name));
    }
    file.json["extensionsRequired"] = {"KHR_materials_sheen"};
    EXPECT_TRUE(has_warning(read(file.glb()), "KHR_materials_sheen"));
}

TEST(Gltf, UndeclaredDracoIsNamed) {
    GltfWriter file = quad();
    file.json["meshes"][0]["primitives"][0]["extensions"] = {
        {"KHR_draco_mesh_compression", {{"bufferView", 0}, {"attributes", json::object()}}}};
    file.json["accessors"][0].erase("bufferView");
    EXPECT_TRUE(mentions(refusal(file), "KHR_draco_mesh_compression"));
}

TEST(Gltf, NumbersThatAreNotFiniteAreRefused) {
    for (const float bad :
         {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity()}) {
        GltfWriter file = quad();
        std::vector<float> positions = kQuadPositions;
        positions[5] = bad;
        const int accessor = file.add_array(positions, tests::kFloat, "VEC3");
        file.json["meshes"][0]["primitives"][0]["attributes"]["POSITION"] = accessor;
        const FileError error = refusal(file);
        EXPECT_EQ(error.place, "meshes[0].primitives[0].attributes.POSITION");
        EXPECT_TRUE(mentions(error, "element 1 of accessor 3")) << error.what();
    }
    GltfWriter far = quad();
    far.json["nodes"][0]["scale"] = {1e30, 1e30, 1e30};
    EXPECT_TRUE(mentions(refusal(far), "1e18"));
}

TEST(Gltf, MissingImagesDoNotMatter) {
    GltfWriter file = quad();
    file.json["images"] = {{{"uri", "missing.png"}}};
    file.json["textures"] = {{{"source", 0}}};
    expect_unit_quad(read(file.glb()));
}

TEST(Gltf, DegenerateTrianglesAreCounted) {
    GltfWriter file = quad();
    file.json["meshes"][0]["primitives"][0]["indices"] = file.add_array(
        std::vector<uint16_t>{0, 1, 2, 0, 2, 3, 1, 1, 2, 2, 0, 1}, tests::kUnsignedShort, "SCALAR");
    const GltfModel model = read(file.glb());
    EXPECT_EQ(model.parts.at(0).mesh.position_index.size(), 2u);
    EXPECT_TRUE(has_warning(model, "1 triangles with two corners at one point"));
    EXPECT_TRUE(has_warning(model, "1 triangles that lie on another"));
}

/// One damage to a sound file, and where the error must say that it is.
struct Damage {
    std::string place;
    std::function<void(json&)> inflict;
};

TEST(Gltf, EveryDamageIsNamed) {
    const std::string primitive = "meshes[0].primitives[0]";
    const std::vector<Damage> damages = {
        {"accessors[0].byteOffset", [](json& j) { j["accessors"][0]["byteOffset"] = -4; }},
        {"accessors[0].count", [](json& j) { j["accessors"][0]["count"] = 4.5; }},
        {"accessors[0].bufferView", [](json& j) { j["accessors"][0]["bufferView"] = "0"; }},
        {"accessors[0].normalized", [](json& j) { j["accessors"][0]["normalized"] = 1; }},
        {"bufferViews[0].byteLength", [](json& j) { j["bufferViews"][0]["byteLength"] = -1; }},
        {"nodes[0].mesh", [](json& j) { j["nodes"][0]["mesh"] = -1; }},
        {"nodes[0].mesh", [](json& j) { j["nodes"][0]["mesh"] = 3; }},
        {"nodes[0].matrix",
         [](json& j) {
             j["nodes"][0]["matrix"] = {1, 0, 0};
         }},
        {"nodes[0].scale",
         [](json& j) {
             j["nodes"][0]["scale"] = {1, "a", 1};
         }},
        {"nodes[0].rotation",
         [](json& j) {
             j["nodes"][0]["rotation"] = {0, 0, 0, 0};
         }},
        {"nodes[0].children[0]", [](json& j) { j["nodes"][0]["children"] = {-1}; }},
        {"asset.version", [](json& j) { j["asset"]["version"] = "1.0"; }},
        {"nodes[0]", [](json& j) { j["nodes"][0] = 5; }},
        {"meshes", [](json& j) { j["meshes"] = 5; }},
        {primitive + ".attributes.POSITION",
         [](json& j) { j["meshes"][0]["primitives"][0]["attributes"]["POSITION"] = 77; }},
        {primitive + ".attributes.POSITION",
         [](json& j) { j["accessors"][0]["count"] = uint64_t{1} << 50; }},
        {primitive + ".attributes.POSITION", [](json& j) { j["accessors"][0]["count"] = 5; }},
        {primitive + ".attributes.POSITION", [](json& j) { j["accessors"][0]["count"] = 0; }},
        {primitive + ".attributes.POSITION",
         [](json& j) { j["accessors"][0]["byteOffset"] = uint64_t{1} << 50; }},
        {primitive + ".attributes.POSITION", [](json& j) { j["accessors"][0]["bufferView"] = 9; }},
        {primitive + ".attributes.POSITION", [](json& j) { j["accessors"][0]["type"] = "VEC2"; }},
        {primitive + ".attributes.POSITION",
         [](json& j) { j["accessors"][0]["componentType"] = 5125; }},
        {primitive + ".attributes.POSITION",
         [](json& j) { j["bufferViews"][0]["byteLength"] = 1000; }},
        {primitive + ".attributes.POSITION",
         [](json& j) { j["bufferViews"][0]["byteStride"] = 4; }},
        {primitive + ".attributes.POSITION", [](json& j) { j["bufferViews"][0]["buffer"] = 2; }},
        {primitive + ".attributes.TEXCOORD_0", [](json& j) { j["accessors"][1]["count"] = 3; }},
        {primitive + ".indices", [](json& j) { j["accessors"][0]["count"] = 3; }},
        {primitive + ".indices", [](json& j) { j["accessors"][2]["count"] = 5; }},
        {primitive + ".indices", [](json& j) { j["accessors"][2]["componentType"] = 5122; }},
        {primitive + ".material", [](json& j) { j["meshes"][0]["primitives"][0]["material"] = 0; }},
        {primitive + ".mode", [](json& j) { j["meshes"][0]["primitives"][0]["mode"] = 9; }},
    };
    for (size_t i = 0; i < damages.size(); ++i) {
        GltfWriter file = quad();
        damages[i].inflict(file.json);
        const FileError error = refusal(file);
        EXPECT_EQ(error.place, damages[i].place) << i << ": " << error.what();
    }
}

TEST(Gltf, DeepNestingIsRefused) {
    const int depth = 200000;
    const std::string text = R"({"asset":{"version":"2.0"},"extras":)" + std::string(depth, '[') +
                             std::string(depth, ']') + "}";
    EXPECT_TRUE(mentions(refusal([&] { read(text, "deep.gltf"); }), "deep"));
}

TEST(Gltf, TruncatedAndDamagedFilesAreRefusedOrRead) {
    const std::string file = quad().glb();
    for (size_t i = 0; i < 200; ++i) {
        const size_t length = i * file.size() / 200;
        EXPECT_FALSE(mentions(refusal([&] { read(file.substr(0, length)); }), "accepted"))
            << length;
    }
    // Any one byte changed: an error or a mesh, and never anything else.
    for (size_t i = 0; i < file.size(); i += 3) {
        std::string changed = file;
        changed[i] = static_cast<char>(changed[i] ^ (1 << i % 8));
        refusal([&] { read(changed); });
    }
}

TEST(Gltf, OneByteCannotReadPastTheBinaryChunk) {
    // A chunk length that ends inside the file only if its own header is forgotten.
    std::string file = quad().glb();
    const uint32_t json_length = static_cast<uint8_t>(file[12]) | static_cast<uint8_t>(file[13])
                                                                      << 8;
    file[20 + json_length] = static_cast<char>(file[20 + json_length] + 8);
    EXPECT_FALSE(mentions(refusal([&] { read(file); }), "accepted"));
}

TEST(Gltf, SharedBrokenFilesAreRefused) {
    RAPPORT_SHARED_DATA_OR_SKIP(data);
    int count = 0;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(data / "invalid-gltf")) {
        const std::string extension = entry.path().extension();
        if (extension != ".gltf" && extension != ".glb")
            continue;
        ++count;
        // None of them has a scene to show, so even the sound ones cannot be accepted.
        EXPECT_FALSE(mentions(refusal([&] { read_gltf(entry.path()); }), "accepted"))
            << entry.path();
    }
    EXPECT_GE(count, 60);
}

TEST(Gltf, SharedModels) {
    RAPPORT_SHARED_DATA_OR_SKIP(data);
    const auto triangles = [&](const std::string& name) {
        size_t count = 0;
        for (const GltfPart& part : read_gltf(data / "gltf" / name).parts)
            count += part.mesh.position_index.size();
        return count;
    };
    EXPECT_EQ(triangles("Corset/Corset.gltf"), 18324u);
    EXPECT_EQ(triangles("SheenCloth/SheenCloth.gltf"), 115200u);
    EXPECT_EQ(triangles("leather_jacket.glb"), 4428u);
    EXPECT_EQ(triangles("tshirt_lengan_pendek.glb"), 34692u);
    EXPECT_EQ(triangles("SimpleSparseAccessor/SimpleSparseAccessor.gltf"), 12u);
    EXPECT_TRUE(mentions(refusal([&] { triangles("shorts_meshopt_noUV.glb"); }),
                         "not supported: EXT_meshopt_compression"));
    EXPECT_TRUE(
        has_warning(read_gltf(data / "gltf/SheenCloth/SheenCloth.gltf"), "KHR_materials_sheen"));
    // UVs of their own at every corner, or shared: the same once merged by value.
    const GltfModel welded = read_gltf(data / "gltf/blouse-iso.glb");
    const GltfModel unwelded = read_gltf(data / "gltf/blouse-iso_unwelded-uv.glb");
    EXPECT_EQ(welded.parts[0].mesh.positions.size(), unwelded.parts[0].mesh.positions.size());
    EXPECT_EQ(welded.parts[0].mesh.uvs.size(), unwelded.parts[0].mesh.uvs.size());
}

TEST(Gltf, TruncatedSharedModelIsRefused) {
    RAPPORT_SHARED_DATA_OR_SKIP(data);
    const std::string file = tests::read_bytes(data / "gltf/blouse-iso.glb");
    for (size_t i = 0; i < 200; ++i)
        EXPECT_FALSE(
            mentions(refusal([&] { read(file.substr(0, i * file.size() / 200)); }), "accepted"));
}

} // namespace
} // namespace rapport
