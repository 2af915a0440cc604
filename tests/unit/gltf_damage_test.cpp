#include "renderer/scene/gltf/gltf.h"

#include "tests/support/gltf_models.h"
#include "tests/support/shared_data.h"

#include <limits>

namespace rapport {
namespace {

using namespace tests;
using nlohmann::json;

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

TEST(Gltf, NumbersBeyondDoubleAreRefused) {
    const std::string text = R"({"asset":{"version":"2.0"},"extras":1e999})";
    EXPECT_TRUE(mentions(refusal([&] { read(text, "huge.gltf"); }), "1e999"));
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

TEST(Gltf, AHeaderThatLeavesNoRoomForAChunkIsRefused) {
    std::string file = quad().glb();
    file[13] = static_cast<char>(file[13] + 0x40); // a JSON chunk beyond the end of the file
    for (const char length : {0, 12, 19}) {
        file.replace(8, 4, {length, 0, 0, 0});
        EXPECT_EQ(refusal([&] { read(file); }).place, "header");
    }
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
    // The sound ones are read to the end: there is nothing wrong but that no scene is there.
    for (const char* sound : {"mesh/valid.gltf", "buffer_view/valid.gltf"})
        if (const auto path = data / "invalid-gltf" / sound; std::filesystem::exists(path)) {
            const FileError error = refusal([&] { read_gltf(path); });
            EXPECT_EQ(error.expected, "a scene with a node that shows a mesh") << error.what();
        }
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
