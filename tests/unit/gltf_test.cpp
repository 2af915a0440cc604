#include "renderer/scene/gltf/gltf.h"

#include "tests/support/gltf_models.h"
#include "tests/support/shared_data.h"

#include <cmath>

namespace rapport {
namespace {

using namespace tests;
using nlohmann::json;

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
    const FileError missing = refusal([&] { read_gltf(folder / "model.gltf"); });
    EXPECT_TRUE(mentions(missing, "data.bin"));
    EXPECT_EQ(missing.place, "buffers[0].uri");
    EXPECT_EQ(refusal([&] { read(file.with_buffer_file(""), "model.gltf"); }).place,
              "buffers[0].uri");
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

TEST(Gltf, FlattenedNodesShowWhatIsLeft) {
    GltfWriter file = quad();
    file.json["meshes"][0]["primitives"][0]["attributes"]["NORMAL"] =
        file.add_array(std::vector<float>{0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1}, kFloat, "VEC3");
    file.json["nodes"][0]["scale"] = {1, 1, 0};
    const GltfModel flat = read(file.glb());
    expect_unit_quad(flat);
    EXPECT_TRUE(flat.parts.at(0).mesh.normals.empty()); // they cannot be carried over
    EXPECT_TRUE(flat.warnings.empty());
    file.json["nodes"][0]["scale"] = {1, 0, 0};
    EXPECT_TRUE(mentions(refusal(file), "none (nodes[0]: its transform leaves no surface"));
    file.add_node({{"mesh", 0}});
    EXPECT_TRUE(has_warning(read(file.glb()), "nodes[0]: its transform leaves no surface"));
}

TEST(Gltf, WhatIsIgnoredIsCounted) {
    GltfWriter file = quad();
    file.json["meshes"][0]["primitives"][0]["material"] = 0;
    file.json["meshes"].push_back(file.json["meshes"][0]);
    file.add_node({{"mesh", 0}});
    file.add_node({{"mesh", 1}});
    file.json["materials"] = {{{"emissiveFactor", {0, 1, 0}}},
                              {{"emissiveFactor", {1, 0, 0}}}}; // which nothing wears
    const GltfModel model = read(file.glb());
    EXPECT_EQ(model.warnings.size(), 1u);
    EXPECT_TRUE(has_warning(model, "1 materials with emission"));
}

TEST(Gltf, DamageIsNamedAlsoWithoutAScene) {
    GltfWriter file = quad();
    file.json["nodes"] = json::array();
    file.json["accessors"][0]["count"] = 5;
    EXPECT_TRUE(refusal(file).place.starts_with("meshes[0].primitives[0]")) << refusal(file).what();
    file.json["asset"]["minVersion"] = "2.1";
    EXPECT_EQ(refusal(file).place, "asset.minVersion");
}

TEST(Gltf, ABadDataUriIsCut) {
    const std::string uri = "data:image/webp;base64," + std::string(1000, 'A');
    const FileError error = refusal([&] { read(quad().with_buffer_file(uri), "model.gltf"); });
    EXPECT_TRUE(mentions(error, "data:image/webp;base64,AAA")) << error.what();
    EXPECT_EQ(error.place, "buffers[0].uri");
    EXPECT_LT(std::string(error.what()).size(), 400u);
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

TEST(Gltf, MissingImagesDoNotMatter) {
    GltfWriter file = quad();
    file.json["images"] = {{{"uri", "missing.png"}}};
    file.json["textures"] = {{{"source", 0}}};
    expect_unit_quad(read(file.glb()));
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

} // namespace
} // namespace rapport
