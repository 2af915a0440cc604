#include "renderer/scene/gltf/gltf.h"

#include "tests/support/gltf_models.h"

// Meshes as their nodes pose them: morph targets at their default weights, skins where their joints
// stand.

namespace rapport {
namespace {

using namespace tests;
using nlohmann::json;

/// A quad whose first target lifts it by 4, and whose second moves u by 2 and tilts the normals.
GltfWriter morphed_quad() {
    GltfWriter file = quad();
    const int lift =
        file.add_array(std::vector<float>{0, 0, 4, 0, 0, 4, 0, 0, 4, 0, 0, 4}, kFloat, "VEC3");
    const int slide = file.add_array(std::vector<float>{2, 0, 2, 0, 2, 0, 2, 0}, kFloat, "VEC2");
    const int tilt =
        file.add_array(std::vector<float>{1, 0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0}, kFloat, "VEC3");
    json& primitive = file.json["meshes"][0]["primitives"][0];
    primitive["attributes"]["NORMAL"] =
        file.add_array(std::vector<float>{0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1}, kFloat, "VEC3");
    primitive["targets"] = {{{"POSITION", lift}}, {{"TEXCOORD_0", slide}, {"NORMAL", tilt}}};
    return file;
}

TEST(GltfMorph, TargetsStandAtTheirDefaultWeights) {
    GltfWriter file = morphed_quad();
    expect_unit_quad(read(file.glb())); // no weights: all are 0
    file.json["meshes"][0]["weights"] = {0.5, 1};
    const IndexedMesh lifted = read(file.glb()).parts.at(0).mesh;
    for (size_t v = 0; v < 4; ++v) {
        EXPECT_EQ(lifted.positions[v].z, 2);
        EXPECT_EQ(lifted.uvs[v].x, lifted.positions[v].x + 2);
    }
    EXPECT_NEAR(glm::distance(lifted.normals.at(0), glm::normalize(glm::vec3(1, 0, 1))), 0, 1e-6);
    file.json["nodes"][0]["weights"] = {-1, 0}; // the node has the last word
    file.add_node({{"mesh", 0}});
    const GltfModel model = read(file.glb());
    EXPECT_EQ(model.parts.at(0).mesh.positions[0].z, -4);
    EXPECT_EQ(model.parts.at(1).mesh.positions[0].z, 2);
    EXPECT_TRUE(model.warnings.empty());
}

TEST(GltfMorph, DamageIsNamed) {
    GltfWriter file = morphed_quad();
    file.json["meshes"][0]["weights"] = {1};
    EXPECT_EQ(refusal(file).place, "meshes[0].primitives[0].targets");
    file.json["meshes"][0]["weights"] = {1, "much"};
    EXPECT_EQ(refusal(file).place, "meshes[0].weights");
    file.json["meshes"][0]["weights"] = {1, 1};
    file.json["meshes"][0]["primitives"][0]["targets"][0]["POSITION"] = 99;
    EXPECT_EQ(refusal(file).place, "meshes[0].primitives[0].targets[0].POSITION");
    file.json["meshes"][0]["primitives"][0]["targets"][0]["POSITION"] = -1;
    EXPECT_EQ(refusal(file).place, "meshes[0].primitives[0].targets[0].POSITION");
    const int few = file.add_array(std::vector<float>{0, 0, 1}, kFloat, "VEC3");
    file.json["meshes"][0]["primitives"][0]["targets"][0]["POSITION"] = few;
    EXPECT_TRUE(mentions(refusal(file), "4 elements, as POSITION has"));
}

/// The quad on two joints: the left edge hangs on joint 0 at the origin, the right one on joint 1,
/// which is bound at x = 1 and stands at (1, 0, 3).
GltfWriter skinned_quad(const std::string& weight_type = "float") {
    GltfWriter file = quad();
    json& primitive = file.json["meshes"][0]["primitives"][0];
    primitive["attributes"]["JOINTS_0"] =
        file.add_array(std::vector<uint8_t>{0, 1, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0},
                       kUnsignedByte, "VEC4");
    // One weight each; a second joint of weight 0 must not matter.
    if (weight_type == "float")
        primitive["attributes"]["WEIGHTS_0"] = file.add_array(
            std::vector<float>{1, 0, 0, 0, 2, 0, 0, 0, 1, 0, 0, 0, 0.5, 0, 0, 0}, kFloat, "VEC4");
    else
        primitive["attributes"]["WEIGHTS_0"] = file.add_array(
            std::vector<uint8_t>{255, 0, 0, 0, 255, 0, 0, 0, 255, 0, 0, 0, 255, 0, 0, 0},
            kUnsignedByte, "VEC4", true);
    std::vector<float> inverse(32, 0);
    for (size_t j = 0; j < 2; ++j)
        for (size_t i = 0; i < 4; ++i)
            inverse[16 * j + 5 * i] = 1;
    inverse[16 + 12] = -1; // joint 1 was bound at x = 1
    file.json["skins"] = {
        {{"joints", {1, 2}}, {"inverseBindMatrices", file.add_array(inverse, kFloat, "MAT4")}}};
    file.json["nodes"] = {{{"mesh", 0}, {"skin", 0}, {"translation", {50, 60, 70}}},
                          {{"children", {2}}},
                          {{"translation", {1, 0, 3}}}};
    return file;
}

TEST(GltfSkin, VerticesGoWithTheirJoints) {
    for (const std::string type : {"float", "normalised bytes"}) {
        const IndexedMesh mesh = read(skinned_quad(type).glb()).parts.at(0).mesh;
        ASSERT_EQ(mesh.positions.size(), 4u);
        for (const glm::vec3& p : mesh.positions) // the node's own place does not count
            EXPECT_EQ(p.z, 3 * p.x);
    }
    GltfWriter file = skinned_quad();
    file.json["skins"][0].erase("inverseBindMatrices"); // then they are identities
    EXPECT_EQ(read(file.glb()).parts.at(0).mesh.positions[1], glm::vec3(2, 0, 3));
}

TEST(GltfSkin, WeightsMixAndSeveralSetsCount) {
    GltfWriter file = skinned_quad();
    json& attributes = file.json["meshes"][0]["primitives"][0]["attributes"];
    const std::vector<uint16_t> other = {1, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 1, 0, 0, 0};
    attributes["JOINTS_1"] = file.add_array(other, kUnsignedShort, "VEC4");
    attributes["WEIGHTS_1"] = file.add_array(
        std::vector<float>{1, 0, 0, 0, 2, 0, 0, 0, 1, 0, 0, 0, 0.5, 0, 0, 0}, kFloat, "VEC4");
    const GltfModel model = read(file.glb());
    for (const glm::vec3& p : model.parts.at(0).mesh.positions)
        EXPECT_FLOAT_EQ(p.z, 1.5f); // half way between the joints, all of them
}

TEST(GltfSkin, NormalsTurnAndReflectionsAreTurnedRound) {
    GltfWriter file = skinned_quad();
    json& attributes = file.json["meshes"][0]["primitives"][0]["attributes"];
    attributes["NORMAL"] =
        file.add_array(std::vector<float>{0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1}, kFloat, "VEC3");
    file.json["nodes"][2].erase("translation");
    file.json["nodes"][1]["rotation"] = {std::sqrt(0.5), 0, 0, std::sqrt(0.5)}; // z → −y
    file.json["skins"][0].erase("inverseBindMatrices");
    const IndexedMesh turned = read(file.glb()).parts.at(0).mesh;
    for (const glm::vec3& n : turned.normals)
        EXPECT_NEAR(glm::distance(n, glm::vec3(0, -1, 0)), 0, 1e-6);
    file.json["nodes"][1] = {{"children", {2}}, {"scale", {-1, 1, 1}}};
    const GltfModel mirrored = read(file.glb());
    EXPECT_EQ(doubled_area(mirrored.parts.at(0).mesh), glm::vec3(0, 0, 2));
    EXPECT_TRUE(has_warning(mirrored, "nodes[0]: mirrored"));
}

TEST(GltfSkin, VerticesWithoutWeightStay) {
    GltfWriter file = skinned_quad();
    file.json["meshes"][0]["primitives"][0]["attributes"]["WEIGHTS_0"] = file.add_array(
        std::vector<float>{1, 0, 0, 0, 0, 0, 0, 0, 1, 0, 0, 0, 0.5, 0, 0, 0}, kFloat, "VEC4");
    const GltfModel model = read(file.glb());
    EXPECT_EQ(model.parts.at(0).mesh.positions[1], glm::vec3(1, 0, 0));
    EXPECT_TRUE(has_warning(model, "1 vertices hang on no joint"));
}

TEST(GltfSkin, DamageIsNamed) {
    const std::string attributes = "meshes[0].primitives[0].attributes";
    struct Damage {
        std::string place;
        std::function<void(GltfWriter&)> inflict;
    };
    const auto attribute = [](GltfWriter& file) -> json& {
        return file.json["meshes"][0]["primitives"][0]["attributes"];
    };
    const std::vector<Damage> damages{
        {"skins[3]", [](GltfWriter& f) { f.json["nodes"][0]["skin"] = 3; }},
        {"skins[0].joints", [](GltfWriter& f) { f.json["skins"][0]["joints"] = json::array(); }},
        {"skins[0].joints[1]", [](GltfWriter& f) { f.json["skins"][0]["joints"][1] = 9; }},
        {"skins[0].joints[0]",
         [](GltfWriter& f) {
             f.json["scenes"] = {{{"nodes", {0}}}};
         }},
        {"skins[0].inverseBindMatrices",
         [](GltfWriter& f) { f.json["skins"][0]["inverseBindMatrices"] = 0; }},
        {attributes, [&](GltfWriter& f) { attribute(f).erase("WEIGHTS_0"); }},
        {attributes,
         [&](GltfWriter& f) { attribute(f).erase("JOINTS_0"), attribute(f).erase("WEIGHTS_0"); }},
        {attributes + ".JOINTS_0",
         [&](GltfWriter& f) {
             attribute(f)["JOINTS_0"] =
                 f.add_array(std::vector<uint8_t>(16, 2), kUnsignedByte, "VEC4");
         }},
        {attributes + ".WEIGHTS_0",
         [&](GltfWriter& f) {
             attribute(f)["WEIGHTS_0"] = f.add_array(std::vector<float>(16, -1), kFloat, "VEC4");
         }},
        {attributes + ".WEIGHTS_0",
         [&](GltfWriter& f) {
             attribute(f)["WEIGHTS_0"] = f.add_array(std::vector<float>(12, 1), kFloat, "VEC4");
         }},
    };
    for (const Damage& damage : damages) {
        GltfWriter file = skinned_quad();
        damage.inflict(file);
        EXPECT_EQ(refusal(file).place, damage.place) << refusal(file).what();
    }
}

} // namespace
} // namespace rapport
