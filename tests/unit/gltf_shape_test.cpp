#include "renderer/scene/shape/shape.h"

#include "renderer/scene/mesh/face_pattern.h"
#include "renderer/scene/mesh/strain.h"
#include "renderer/scene/mesh/subdivision.h"
#include "tests/support/control_meshes.h"
#include "tests/support/gltf_models.h"
#include "tests/support/shared_data.h"

#include <algorithm>

// What a glTF shape is asked for: frames along the file's tangents, and how a cloth is strained.

namespace rapport {
namespace {

using namespace tests;

struct Made {
    std::vector<ShapePart> parts;
    std::vector<std::string> warnings;

    const TriangleMesh& mesh() const { return parts.at(0).mesh; }
    bool tells(const std::string& text) const {
        return std::ranges::any_of(warnings, [&](const std::string& line) {
            return line.find(text) != std::string::npos;
        });
    }
};

/// The shape of `path`, which wears a cloth, of 4 pixels to a metre.
Made make(const std::filesystem::path& path, const std::vector<Param>& more,
          bool wears_cloth = true) {
    Params params("scene.pbrt", "Shape \"gltf\"", 1);
    params.add({.type = "string", .name = "filename", .numbers = {}, .strings = {path.string()}});
    for (const Param& param : more)
        params.add(param);
    Made made;
    made.parts = make_shape(
        "gltf", {params,
                 {},
                 [&](const std::string&) { return wears_cloth; },
                 made.warnings,
                 [](const glm::dvec3& a, const glm::dvec3& b) { return 4 * glm::distance(a, b); },
                 nullptr});
    return made;
}
Made make(const GltfWriter& file, const std::vector<Param>& more, bool wears_cloth = true) {
    const TemporaryFolder folder;
    write_bytes(folder / "model.glb", file.glb());
    return make(folder / "model.glb", more, wears_cloth);
}

Param number(const std::string& type, const std::string& name, double value) {
    return {.type = type, .name = name, .numbers = {value}, .strings = {}};
}
const Param kTangents = number("bool", "tangents", 1);

/// The square with normals, and tangents 30° off its u; `handedness` is their w.
GltfWriter quad_with_tangents(float handedness) {
    GltfWriter file = quad();
    const float x = std::cos(radians(30.0f)), y = std::sin(radians(30.0f));
    std::vector<float> normals, tangents;
    for (int v = 0; v < 4; ++v) {
        normals.insert(normals.end(), {0, 0, 1});
        tangents.insert(tangents.end(), {x, y, 0, handedness});
    }
    auto& attributes = file.json["meshes"][0]["primitives"][0]["attributes"];
    attributes["NORMAL"] = file.add_array(normals, tests::kFloat, "VEC3");
    attributes["TANGENT"] = file.add_array(tangents, tests::kFloat, "VEC4");
    return file;
}

void expect_warp(const TriangleMesh& mesh, const glm::vec3& warp, const glm::vec3& weft) {
    ASSERT_FALSE(mesh.warp.empty());
    for (size_t v = 0; v < mesh.warp.size(); ++v) {
        EXPECT_LT(glm::distance(glm::normalize(mesh.warp[v]), warp), 1e-6f) << v;
        EXPECT_LT(glm::distance(glm::normalize(mesh.weft[v]), weft), 1e-6f) << v;
    }
}

TEST(Tangents, LeadTheWarpOnRequestAlone) {
    const float x = std::cos(radians(30.0f)), y = std::sin(radians(30.0f));
    const GltfWriter file = quad_with_tangents(1);
    for (const double level : {0.0, 1.0, 3.0}) {
        const Param cut = number("integer", "level", level);
        expect_warp(make(file, {cut}).mesh(), {0, 1, 0}, {1, 0, 0});
        expect_warp(make(file, {cut, kTangents}).mesh(), {-y, x, 0}, {x, y, 0});
        // On the other side of the tangent: the warp is reversed, and no cloth is mirrored.
        expect_warp(make(quad_with_tangents(-1), {cut, kTangents}).mesh(), {y, -x, 0}, {-x, -y, 0});
        for (const double quads : {0.0, 1.0})
            expect_warp(make(file, {cut, kTangents, number("bool", "quads", quads)}).mesh(),
                        {-y, x, 0}, {x, y, 0});
    }
    // They move with the node, and so does the side on which they lie.
    GltfWriter turned = file;
    turned.json["nodes"][0]["rotation"] = {0, 0, std::sqrt(0.5), std::sqrt(0.5)};
    expect_warp(make(turned, {kTangents}).mesh(), {-x, -y, 0}, {-y, x, 0});
    GltfWriter mirrored = file;
    mirrored.json["nodes"][0]["scale"] = {-1, 1, 1};
    expect_warp(make(mirrored, {kTangents}).mesh(), {y, x, 0}, {x, -y, 0});
}

TEST(Tangents, GoWithMorphTargetsAndSkins) {
    const float x = std::cos(radians(30.0f)), y = std::sin(radians(30.0f));
    GltfWriter morphed = quad_with_tangents(1);
    std::vector<float> turn; // to +y
    for (int v = 0; v < 4; ++v)
        turn.insert(turn.end(), {-x, 1 - y, 0});
    morphed.json["meshes"][0]["primitives"][0]["targets"] = {
        {{"TANGENT", morphed.add_array(turn, tests::kFloat, "VEC3")}}};
    morphed.json["meshes"][0]["weights"] = {1};
    expect_warp(make(morphed, {kTangents}).mesh(), {-1, 0, 0}, {0, 1, 0});

    GltfWriter skinned = quad_with_tangents(1);
    auto& attributes = skinned.json["meshes"][0]["primitives"][0]["attributes"];
    attributes["JOINTS_0"] =
        skinned.add_array(std::vector<uint8_t>(16, 0), tests::kUnsignedByte, "VEC4");
    attributes["WEIGHTS_0"] = skinned.add_array(
        std::vector<float>{1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0}, tests::kFloat, "VEC4");
    skinned.json["skins"] = {{{"joints", {1}}}};
    skinned.json["nodes"] = {{{"mesh", 0}, {"skin", 0}},
                             {{"rotation", {0, 0, std::sqrt(0.5), std::sqrt(0.5)}}}};
    expect_warp(make(skinned, {kTangents}).mesh(), {-x, -y, 0}, {-y, x, 0});
}

TEST(Tangents, AreInterpolatedOverAFace) {
    GltfWriter file = quad_with_tangents(1);
    const std::vector<float> fan{1, 0, 0, 1, 1, 0, 0, 1, 0, 1, 0, 1, 0, 1, 0, 1};
    file.json["meshes"][0]["primitives"][0]["attributes"]["TANGENT"] =
        file.add_array(fan, tests::kFloat, "VEC4");
    // Along u at y = 0, along −x at y = 1, and between these in between. The limit surface of two
    // triangles, not of one quad, draws UVs off their straight lines.
    for (const auto& [quads, tolerance] : {std::pair{1.0, 1e-5f}, {0.0, 0.25f}}) {
        const Made made =
            make(file, {kTangents, number("integer", "level", 8), number("bool", "quads", quads)});
        for (size_t v = 0; v < made.mesh().positions.size(); ++v) {
            const float height = made.mesh().uvs[v].y;
            const glm::vec2 expected = glm::normalize(glm::vec2(-height, 1 - height));
            EXPECT_LT(glm::distance(glm::vec2(made.mesh().warp[v]), expected), tolerance);
        }
    }
}

TEST(CornerShares, AreLinearAlongTheSides) {
    for (const auto& [kind, size] : {std::pair{FaceKind::triangle, 3},
                                     {FaceKind::quad, 4},
                                     {FaceKind::quartered_triangle, 3}}) {
        FacePatterns patterns;
        const FacePattern& cut = patterns.get(kind, {4, 4, 4, size == 4 ? 4 : 0});
        for (int i = 0; i < 4 * size; ++i) { // round the boundary
            const glm::dvec4 shares = corner_shares(kind, cut.points[static_cast<size_t>(i)]);
            const int corner = i / 4;
            EXPECT_NEAR(shares[corner], 1 - i % 4 / 4.0, 1e-6) << i;
            EXPECT_NEAR(shares[(corner + 1) % size], i % 4 / 4.0, 1e-6) << i;
        }
        for (const glm::vec2& point : cut.points) {
            const glm::dvec4 shares = corner_shares(kind, point);
            EXPECT_NEAR(shares.x + shares.y + shares.z + shares.w, 1, 1e-6);
            EXPECT_GE(std::min({shares.x, shares.y, shares.z, shares.w}), -1e-6);
        }
    }
}

TEST(Tangents, ThatAreMissingOrDamagedAreRefusedOnRequestAlone) {
    const FileError none = refusal([] { make(quad(), {kTangents}); });
    EXPECT_TRUE(mentions(none, "TANGENT")) << none.what();
    EXPECT_EQ(make(quad(), {kTangents}, false).parts.size(), 1u); // it wears no cloth
    GltfWriter file = quad_with_tangents(1);
    file.json["meshes"][0]["primitives"][0]["attributes"]["TANGENT"] = 77;
    make(file, {});
    EXPECT_TRUE(mentions(refusal([&] { make(file, {kTangents}); }), "attributes.TANGENT"));
}

/// The Corset's tangents are not quite the derivatives of its UVs: they differ, but by little.
TEST(Tangents, OfASharedModelDifferFromItsUvs) {
    RAPPORT_SHARED_DATA_OR_SKIP(data);
    const std::filesystem::path path = data / "gltf/Corset/Corset.gltf";
    const Param cut = number("integer", "level", 0);
    const Made by_uvs = make(path, {cut}), by_tangents = make(path, {cut, kTangents});
    const TriangleMesh &a = by_uvs.mesh(), &b = by_tangents.mesh();
    expect_sound(b);
    std::vector<float> cosines;
    for (size_t t = 0; t < std::min(a.triangles.size(), b.triangles.size()); ++t)
        cosines.push_back(glm::dot(glm::normalize(a.warp[a.triangles[t].x]),
                                   glm::normalize(b.warp[b.triangles[t].x])));
    std::ranges::sort(cosines);
    EXPECT_GT(cosines[cosines.size() / 2], 0.9f);
    EXPECT_LT(cosines[cosines.size() / 100], 0.99f);
}

TEST(Summary, CountsWhatWasMended) {
    const auto told = [](const std::vector<float>& positions, const std::vector<uint16_t>& indices,
                         double level) {
        std::vector<float> uvs;
        for (size_t i = 0; i < positions.size(); i += 3)
            uvs.insert(uvs.end(), {positions[i], positions[i + 1]}); // mirrored: v runs down
        GltfWriter file;
        const int p = file.add_array(positions, tests::kFloat, "VEC3");
        const int uv = file.add_array(uvs, tests::kFloat, "VEC2");
        const int i = file.add_array(indices, tests::kUnsignedShort, "SCALAR");
        file.add_mesh({{"attributes", {{"POSITION", p}, {"TEXCOORD_0", uv}}}, {"indices", i}});
        file.add_node({{"mesh", 0}});
        return make(file, {number("integer", "level", level)});
    };
    const std::vector<float> bow_tie{0, 0, 0, -1, -1, 0, -1, 1, 0, 1, 1, 0, 1, -1, 0};
    const std::vector<float> unwelded{0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 0, 0, 1, 1, 0, 0, 1, 0};
    const std::vector<float> line{0, 0, 0, 1, 0, 0, 0.5, 0, 0, 0, 1, 0};
    EXPECT_TRUE(told(bow_tie, {0, 2, 1, 0, 4, 3}, 2).tells("1 vertices where pieces meet"));
    EXPECT_TRUE(told(unwelded, {0, 1, 2, 3, 4, 5}, 2).tells("2 repeated vertices merged"));
    EXPECT_TRUE(told(line, {1, 0, 2, 0, 1, 3}, 2).tells("1 triangles without area"));
    for (const double level : {0, 2})
        EXPECT_TRUE(told(unwelded, {0, 1, 2, 3, 4, 5}, level).tells("2 faces with mirrored UVs"));
    // Level 0 tells of mended frames as well: those whose UVs cover no area.
    GltfWriter singular = quad();
    singular.json["meshes"][0]["primitives"][0]["attributes"]["TEXCOORD_0"] =
        singular.add_array(std::vector<float>{0, 1, 1, 1, 1, 0, 0.5, 0.5}, tests::kFloat, "VEC2");
    EXPECT_TRUE(make(singular, {number("integer", "level", 0)}).tells("1 vertices given the warp"));
}

TEST(Strain, IsThatOfTheClothOnTheSurface) {
    const float shear = radians(20.0f);
    CleanMesh mesh = sheet(4, [](float, float) { return 0.0f; });
    // The cloth is pulled 1.25 times as long along the weft, and sheared.
    for (glm::vec3& p : mesh.positions) {
        mesh.uvs.emplace_back(p.x, p.y);
        p = {1.25f * p.x + std::sin(shear) * p.y, std::cos(shear) * p.y, 0};
    }
    mesh.uv_index = mesh.position_index;
    const Strain found = strain(subdivide(mesh, options(2, true), "sheet"), 1);
    for (const auto& [range, expected] :
         {std::pair{found.weft, 1.25}, {found.warp, 1.0}, {found.shear, double{shear}}}) {
        EXPECT_NEAR(range.low, expected, 1e-5);
        EXPECT_NEAR(range.high, expected, 1e-5);
    }
    EXPECT_NEAR(strain(subdivide(mesh, options(2, true), "sheet"), 0.5).warp.high, 2, 1e-5);
}

TEST(Strain, IsToldWhereItIsMuchOrAskedFor) {
    EXPECT_FALSE(make(quad(), {}).tells("stretched"));
    const Made asked = make(quad(), {number("float", "uvscale", 0.5)});
    EXPECT_TRUE(asked.tells("with 0.5 m to a unit of UV the cloth lies stretched by 2.00 to 2.00 "
                            "along the weft and 2.00 to 2.00 along the warp, sheared by 0° to 0°"));
    GltfWriter narrow = quad();
    narrow.json["nodes"][0]["scale"] = {0.5, 1, 1};
    EXPECT_TRUE(
        make(narrow, {}).tells("stretched by 0.71 to 0.71 along the weft and 1.41 to 1.41"));
    EXPECT_FALSE(make(narrow, {}, false).tells("stretched")); // no cloth
    const FileError error = refusal([] { make(quad(), {number("float", "uvscale", 0)}); });
    EXPECT_TRUE(mentions(error, "above 0 m"));
    Param word{.type = "string", .name = "uvscale", .numbers = {}, .strings = {"auto"}};
    EXPECT_TRUE(make(narrow, {word}).tells("with 0.707 m to a unit of UV"));
    word.strings = {"cm"};
    EXPECT_TRUE(mentions(refusal([&] { make(quad(), {word}); }), "\"auto\""));
}

} // namespace
} // namespace rapport
