#include "renderer/core/png.h"
#include "renderer/integrator/path_tracer.h"
#include "renderer/scene/model_scene.h"
#include "renderer/scene/pbrt/pbrt_parser.h"
#include "renderer/scene/scene_builder.h"
#include "tests/support/gltf_models.h"
#include "tests/support/small_scenes.h"

// What a glTF's vertex colours and alphas make of the parts that wear nothing else.

namespace rapport {
namespace {

using namespace tests;
using nlohmann::json;

constexpr float kTolerance = 1e-5f;

json& attributes(GltfWriter& file) { return file.json["meshes"][0]["primitives"][0]["attributes"]; }

/// The unit square with red, green, blue and white corners, as x and y go round from 0.
GltfWriter coloured_quad() {
    GltfWriter file = quad();
    attributes(file)["COLOR_0"] =
        file.add_array(std::vector<float>{1, 0, 0, 0, 1, 0, 0, 0, 1, 1, 1, 1}, kFloat, "VEC3");
    return file;
}

/// As it lies in a scene under a white sky; `shape` and `before` are of its scene file.
Scene scene_of(const GltfWriter& file, const std::string& shape = "\"integer level\" 0",
               const std::string& before = "") {
    const TemporaryFolder folder;
    write_bytes(folder / "model.glb", file.glb());
    write_bytes(folder / "scene.pbrt",
                "LookAt 0.5 0.5 1  0.5 0.5 0  0 1 0\nCamera \"perspective\" \"float fov\" 30\n"
                "Film \"rgb\" \"integer xresolution\" 16 \"integer yresolution\" 16\n"
                "Integrator \"path\" \"integer maxdepth\" 20\n"
                "WorldBegin\nLightSource \"infinite\" \"rgb L\" [1 1 1]\n" +
                    before + "\nShape \"gltf\" \"string filename\" \"model.glb\" " + shape);
    std::vector<std::string> warnings;
    return build_scene(parse_pbrt(folder / "scene.pbrt"), {}, warnings);
}

std::optional<SurfacePoint> seen_at(const Scene& scene, float x, float y) {
    return scene.intersect({{x, y, 0.5f}, {0, 0, -1}});
}

Rgb reflectance_at(const Scene& scene, float x, float y) {
    const auto point = seen_at(scene, x, y);
    EXPECT_TRUE(point);
    return point ? point->surface->material->albedo({0, 0, 1}) * point->reflectance() : Rgb(-1);
}

void expect_color(const Rgb& found, const Rgb& expected, float tolerance = kTolerance) {
    EXPECT_LT(glm::distance(found, expected), tolerance)
        << found.r << ' ' << found.g << ' ' << found.b;
}

TEST(VertexColors, AreInterpolatedOverTheFaces) {
    for (const std::string shape : {"\"integer level\" 0", "\"integer level\" 5", ""}) {
        const Scene scene = scene_of(coloured_quad(), shape);
        expect_color(reflectance_at(scene, 0.75f, 0.25f), {0.25f, 0.5f, 0.25f}, 1e-3f);
        expect_color(reflectance_at(scene, 0.25f, 0.75f), {0.75f, 0.5f, 0.75f}, 1e-3f);
    }
    const Scene joined = scene_of(coloured_quad(), "\"integer level\" 4 \"bool quads\" true");
    expect_color(reflectance_at(joined, 0.5f, 0.5f), Rgb(0.5f), 1e-3f); // bilinear
}

TEST(VertexColors, MultiplyTheBaseColour) {
    GltfWriter file = coloured_quad();
    file.json["materials"] = {
        {{"name", "Body"}, {"pbrMetallicRoughness", {{"baseColorFactor", {0.5, 1, 0.2, 1}}}}}};
    file.json["meshes"][0]["primitives"][0]["material"] = 0;
    expect_color(reflectance_at(scene_of(file), 0.75f, 0.25f), {0.125f, 0.5f, 0.05f});
    // Not another material.
    const std::string stated = "\"rgb reflectance\" [0.4 0.4 0.4]";
    for (const std::string& before :
         {"Material \"diffuse\" " + stated,
          "MakeNamedMaterial \"Body\" \"string type\" \"diffuse\" " + stated})
        expect_color(reflectance_at(scene_of(file, "", before), 0.75f, 0.25f), Rgb(0.4f));
}

TEST(VertexColors, ComeInEveryFormThatGltfKnows) {
    const Rgb expected(0.25f, 0.5f, 0.25f);
    const std::vector<uint8_t> bytes{255, 0, 0,   255, 0,   255, 0,   255,
                                     0,   0, 255, 255, 255, 255, 255, 255};
    GltfWriter by_bytes = quad();
    attributes(by_bytes)["COLOR_0"] = by_bytes.add_accessor(by_bytes.add_view(bytes_of(bytes)),
                                                            kUnsignedByte, 4, "VEC4", 0, true);
    expect_color(reflectance_at(scene_of(by_bytes), 0.75f, 0.25f), expected);

    std::vector<uint16_t> shorts;
    for (const uint8_t byte : bytes)
        shorts.push_back(static_cast<uint16_t>(257 * byte));
    GltfWriter by_shorts = quad();
    attributes(by_shorts)["COLOR_0"] = by_shorts.add_accessor(by_shorts.add_view(bytes_of(shorts)),
                                                              kUnsignedShort, 4, "VEC4", 0, true);
    expect_color(reflectance_at(scene_of(by_shorts), 0.75f, 0.25f), expected);

    // Morphed from black, and clamped.
    GltfWriter morphed = quad();
    attributes(morphed)["COLOR_0"] = morphed.add_array(std::vector<float>(12, 0), kFloat, "VEC3");
    morphed.json["meshes"][0]["primitives"][0]["targets"] = {
        {{"COLOR_0", morphed.add_array(std::vector<float>{4, 0, 0, 0, 4, 0, 0, 0, 4, 4, 4, 4},
                                       kFloat, "VEC3")}}};
    morphed.json["meshes"][0]["weights"] = {0.5};
    expect_color(reflectance_at(scene_of(morphed), 0.75f, 0.25f), expected);

    GltfWriter white = quad();
    attributes(white)["COLOR_0"] = white.add_array(std::vector<float>(12, 1), kFloat, "VEC3");
    EXPECT_TRUE(read(white.glb()).parts.at(0).mesh.colors.empty());
    GltfWriter few = quad();
    attributes(few)["COLOR_0"] = few.add_array(std::vector<float>(9, 1), kFloat, "VEC3");
    EXPECT_TRUE(mentions(refusal(few), "COLOR_0: expected 4 elements"));
}

TEST(VertexColors, StaySharpWhereTheyDiffer) {
    // Two triangles side by side, alike in all but their colours.
    GltfWriter file;
    const int positions = file.add_array(
        std::vector<float>{0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 0, 0, 1, 1, 0, 0, 1, 0}, kFloat, "VEC3");
    const int colors = file.add_array(
        std::vector<float>{1, 0, 0, 1, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 1, 0, 0, 1}, kFloat, "VEC3");
    file.add_mesh({{"attributes", {{"POSITION", positions}, {"COLOR_0", colors}}}});
    file.add_node({{"mesh", 0}});
    const GltfModel model = read(file.glb());
    EXPECT_EQ(model.parts.at(0).mesh.positions.size(), 4u); // one surface
    EXPECT_EQ(model.parts.at(0).mesh.dropped.vertices, 0u);
    for (const std::string level : {"0", "1", "4"}) {
        const Scene scene = scene_of(file, "\"integer level\" " + level);
        expect_color(reflectance_at(scene, 0.51f, 0.49f), {1, 0, 0});
        expect_color(reflectance_at(scene, 0.49f, 0.51f), {0, 0, 1});
    }
}

/// The square in a material of this alphaMode, white, with `alphas` at the four corners of its
/// picture, which the square shows whole: lower left, lower right, upper left, upper right.
GltfWriter quad_with_alpha(const json& material, const std::vector<uint8_t>& alphas = {}) {
    GltfWriter file = quad();
    file.json["materials"] = {material};
    file.json["meshes"][0]["primitives"][0]["material"] = 0;
    if (alphas.empty())
        return file;
    std::vector<uint8_t> rgba;
    for (const size_t i : {2, 3, 0, 1})
        rgba.insert(rgba.end(), {255, 255, 255, alphas[i]});
    file.json["images"] = {
        {{"bufferView", file.add_view(png_file(rgba, 2, 2, 4))}, {"mimeType", "image/png"}}};
    file.json["textures"] = {{{"source", 0}}};
    file.json["materials"][0]["pbrMetallicRoughness"]["baseColorTexture"] = {{"index", 0}};
    return file;
}

/// A black wall a unit behind the square.
const std::string kWall = "AttributeBegin\nMaterial \"diffuse\" \"rgb reflectance\" [0 0 0]\n"
                          "Translate 0 0 -1\nShape \"trianglemesh\" \"integer indices\" [0 1 2] "
                          "\"point3 P\" [-99 -99 0 99 -99 0 0 99 0]\nAttributeEnd";

TEST(Opacity, CutsHolesThroughWhichRaysGo) {
    const GltfWriter file =
        quad_with_alpha({{"alphaMode", "MASK"}, {"alphaCutoff", 0.4}}, {0, 255, 255, 0});
    for (const std::string shape : {"\"integer level\" 0", "\"integer level\" 3"}) {
        const Scene scene = scene_of(file, shape, kWall);
        for (const auto& [x, y] : {std::pair{0.25f, 0.25f}, {0.75f, 0.75f}}) {
            const kernel::Ray ray{{x, y, 0.5f}, {0, 0, -1}};
            EXPECT_NEAR(seen_at(scene, x, y)->distance, 1.5f, kTolerance);
            EXPECT_NEAR(scene.intersect(std::span(&ray, 1))[0]->distance, 1.5f, kTolerance);
            EXPECT_FALSE(scene.intersect({ray.org, ray.dir, 0, 1})); // it ends before the wall
            EXPECT_EQ(scene.transmittance(ray.org, ray.dir, 1, *scene.lights()[0]), Rgb(1));
        }
        EXPECT_NEAR(seen_at(scene, 0.75f, 0.25f)->distance, 0.5f, kTolerance);
        EXPECT_EQ(scene.transmittance({0.75f, 0.25f, 0.5f}, {0, 0, -1}, 1, *scene.lights()[0]),
                  Rgb(0));
    }
    // Half way between an alpha of 1 and one of 0, both cutoffs are far from it.
    EXPECT_NEAR(seen_at(scene_of(file, "", kWall), 0.5f, 0.5f)->distance, 0.5f, kTolerance);
    const GltfWriter opaque = quad_with_alpha({{"alphaMode", "OPAQUE"}}, {0, 255, 255, 0});
    EXPECT_NEAR(seen_at(scene_of(opaque, "", kWall), 0.25f, 0.25f)->distance, 0.5f, kTolerance);
    const GltfWriter gone = quad_with_alpha({{"alphaMode", "BLEND"}}, {0, 0, 0, 0});
    EXPECT_NEAR(seen_at(scene_of(gone, "", kWall), 0.3f, 0.2f)->distance, 1.5f, kTolerance);
    // A stated material has no holes, nor has what shines.
    for (const std::string before : {"Material \"diffuse\"", "AreaLightSource \"diffuse\""})
        EXPECT_NEAR(seen_at(scene_of(file, "", kWall + "\n" + before), 0.25f, 0.25f)->distance,
                    0.5f, kTolerance);
}

TEST(Opacity, OfManyHolesInARowEndsSomewhere) {
    GltfWriter file = quad_with_alpha({{"alphaMode", "MASK"}}, {0, 0, 0, 0});
    for (int i = 0; i < 200; ++i)
        file.add_node({{"mesh", 0}, {"translation", {0, 0, -0.001 * i}}});
    const Scene scene = scene_of(file, "", kWall);
    EXPECT_NEAR(seen_at(scene, 0.3f, 0.2f)->distance, 1.5f, 1e-4f);
}

/// Mean radiance over the picture, which the square fills.
double mean_radiance(Scene scene) {
    scene.settings.samples = 256;
    const Image image = render(scene).image();
    double sum = 0;
    for (const float value : *image.find("R"))
        sum += value;
    return sum / static_cast<double>(image.find("R")->size());
}

TEST(Opacity, BlendsWithWhatIsBehind) {
    json material = {{"alphaMode", "BLEND"},
                     {"pbrMetallicRoughness", {{"baseColorFactor", {1, 1, 1, 0.5}}}}};
    // White under a white sky is seen as the sky, however much of it there is.
    EXPECT_NEAR(mean_radiance(scene_of(quad_with_alpha(material))), 1, 1e-3);
    // Of black, only what is not there is bright: by camera rays, whose errors are known ...
    const auto black = [&](double alpha) {
        material["pbrMetallicRoughness"]["baseColorFactor"] = {0, 0, 0, alpha};
        return scene_of(quad_with_alpha(material));
    };
    const double error = std::sqrt(0.25 / (256 * 16 * 16));
    for (const double alpha : {0.25, 0.5, 0.9})
        EXPECT_NEAR(mean_radiance(black(alpha)), 1 - alpha, 5 * error) << alpha;
    // ... and by shadow rays.
    const Scene quarter = black(0.25);
    EXPECT_NEAR(quarter.transmittance({0.5f, 0.5f, 1}, {0, 0, -1}, 2, *quarter.lights()[0]).r,
                0.75f, kTolerance);
    // The alphas of factor, picture and vertices multiply.
    material["pbrMetallicRoughness"]["baseColorFactor"] = {0, 0, 0, 0.8};
    GltfWriter all = quad_with_alpha(material, {128, 128, 128, 128});
    attributes(all)["COLOR_0"] = all.add_array(
        std::vector<float>{1, 1, 1, 0.5f, 1, 1, 1, 0.5f, 1, 1, 1, 0.5f, 1, 1, 1, 0.5f}, kFloat,
        "VEC4");
    EXPECT_NEAR(seen_at(scene_of(all), 0.5f, 0.5f)->opacity, 0.8f * 128 / 255 * 0.5f, kTolerance);
}

TEST(Opacity, MistakesAreNamed) {
    const auto refused = [](const json& material) { return refusal(quad_with_alpha(material)); };
    EXPECT_TRUE(
        mentions(refused({{"alphaMode", "SHEER"}}),
                 "materials[0].alphaMode: expected OPAQUE, MASK or BLEND, found \"SHEER\""));
    EXPECT_TRUE(mentions(refused({{"alphaMode", "MASK"}, {"alphaCutoff", -1}}), "alphaCutoff"));
    EXPECT_TRUE(mentions(refused({{"pbrMetallicRoughness", {{"baseColorFactor", {1, 1, 1, 2}}}}}),
                         "baseColorFactor: expected numbers in [0, 1]"));
}

} // namespace
} // namespace rapport
