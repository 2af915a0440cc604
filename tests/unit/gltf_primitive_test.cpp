#include "renderer/scene/gltf/gltf.h"

#include "tests/support/gltf_models.h"

namespace rapport {
namespace {

using namespace tests;
using nlohmann::json;

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

// All indices are 0 but those of the sparse values, and tinygltf wants a bufferView for indices.
TEST(Gltf, AccessorsWithoutBufferViewAreZeros) {
    GltfWriter file = quad();
    const int where = file.add_view(bytes_of(std::vector<uint8_t>{1, 2, 4, 5}));
    const int what = file.add_view(bytes_of(std::vector<uint16_t>{1, 2, 2, 3}));
    const int indices = file.add_accessor(-1, kUnsignedShort, 6, "SCALAR");
    json& accessor = file.json["accessors"][static_cast<size_t>(indices)];
    accessor["sparse"] = {{"count", 4},
                          {"indices", {{"bufferView", where}, {"componentType", kUnsignedByte}}},
                          {"values", {{"bufferView", what}}}};
    file.json["meshes"][0]["primitives"][0]["indices"] = indices;
    expect_unit_quad(read(file.glb()));
    expect_unit_quad(read(file.embedded(), "model.gltf"));
    accessor.erase("sparse"); // every corner at vertex 0
    EXPECT_TRUE(mentions(refusal(file), "meshes with triangles"));
    accessor["count"] = 1 << 20;
    EXPECT_EQ(refusal(file).place, "meshes[0].primitives[0].indices");
}

TEST(Gltf, TextureTransformComesBeforeTheFlip) {
    GltfWriter file = quad();
    file.json["extensionsRequired"] = {"KHR_texture_transform"};
    file.json["textures"] = {json::object()};
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
    // Meant for another set of coordinates, which there is not: the first stays as it is.
    json& texture = file.json["materials"][0]["pbrMetallicRoughness"]["baseColorTexture"];
    texture["extensions"]["KHR_texture_transform"] = {{"texCoord", 1}, {"offset", {5, 0}}};
    expect_unit_quad(read(file.glb()));
    // With it, that set is the one. Here it is the first, moved back.
    std::vector<float> moved = kQuadUvs;
    for (size_t i = 0; i < moved.size(); i += 2)
        moved[i] -= 5;
    primitive["attributes"]["TEXCOORD_1"] = file.add_array(moved, tests::kFloat, "VEC2");
    expect_unit_quad(read(file.glb()));
    texture["extensions"]["KHR_texture_transform"].erase("texCoord");
    texture["texCoord"] = 1;
    expect_unit_quad(read(file.glb()));
    texture["extensions"]["KHR_texture_transform"] = {{"scale", {1, 2, 3}}};
    EXPECT_TRUE(mentions(refusal(file), "KHR_texture_transform.scale"));
}

TEST(Gltf, DegenerateTrianglesAreCounted) {
    GltfWriter file = quad();
    file.json["meshes"][0]["primitives"][0]["indices"] = file.add_array(
        std::vector<uint16_t>{0, 1, 2, 0, 2, 3, 1, 1, 2, 2, 0, 1}, tests::kUnsignedShort, "SCALAR");
    const GltfModel model = read(file.glb());
    EXPECT_EQ(model.parts.at(0).mesh.position_index.size(), 2u);
    EXPECT_EQ(model.parts[0].mesh.dropped.degenerate, 1u);
    EXPECT_EQ(model.parts[0].mesh.dropped.repeated, 1u);
}

} // namespace
} // namespace rapport
