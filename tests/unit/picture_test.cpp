#include "renderer/scene/picture.h"

#include "renderer/core/image.h"
#include "renderer/scene/model_scene.h"
#include "renderer/scene/pbrt/pbrt_parser.h"
#include "renderer/scene/scene_builder.h"
#include "tests/support/gltf_models.h"

// Reflectance from pictures: pbrt's imagemap on diffuse, and the base colour of a glTF's parts.

namespace rapport {
namespace {

using namespace tests;
using nlohmann::json;
using Wrap = PictureMapping::Wrap;

/// 2 × 2 pixels: red and green above, blue and half (linear) grey below.
std::string picture_file() {
    const TemporaryFolder folder;
    Image image(2, 2, {"R", "G", "B"});
    image.data = {{1, 0, 0, 0.5f}, {0, 1, 0, 0.5f}, {0, 0, 1, 0.5f}};
    write_png(image, folder / "picture.png");
    return read_bytes(folder / "picture.png");
}

std::shared_ptr<const Picture> picture() {
    const std::string file = picture_file();
    return std::make_shared<Picture>(
        std::span(reinterpret_cast<const unsigned char*>(file.data()), file.size()), "picture");
}

void expect_color(const Rgb& found, const Rgb& expected, float tolerance = 5e-3f) {
    EXPECT_LT(glm::distance(found, expected), tolerance)
        << found.r << ' ' << found.g << ' ' << found.b;
}

TEST(Picture, StandsUprightOnTheUnitSquare) {
    const PictureTexture texture(picture(), {}, Rgb(1));
    expect_color(texture({0.25f, 0.75f}), {1, 0, 0});
    expect_color(texture({0.75f, 0.75f}), {0, 1, 0});
    expect_color(texture({0.25f, 0.25f}), {0, 0, 1});
    expect_color(texture({0.75f, 0.25f}), Rgb(0.5f)); // decoded from sRGB
    expect_color(texture({0.5f, 0.75f}), {0.5f, 0.5f, 0});
    PictureMapping encoded;
    encoded.linear = true;
    expect_color(PictureTexture(picture(), encoded, {1, 0.5f, 1})({0.75f, 0.25f}),
                 {0.7354f, 0.3677f, 0.7354f});
}

TEST(Picture, GoesOnBeyondTheSquareAsAsked) {
    const auto at = [](Wrap wrap, const glm::vec2& uv) {
        PictureMapping mapping;
        mapping.wrap_u = mapping.wrap_v = wrap;
        return PictureTexture(picture(), mapping, Rgb(1))(uv);
    };
    expect_color(at(Wrap::repeat, {-0.75f, 3.75f}), {1, 0, 0});
    expect_color(at(Wrap::mirror, {-0.25f, 0.75f}), {1, 0, 0});
    expect_color(at(Wrap::mirror, {1.75f, -0.75f}), {1, 0, 0});
    expect_color(at(Wrap::clamp, {-9, 9}), {1, 0, 0});
    expect_color(at(Wrap::black, {-9, 9}), Rgb(0));
    expect_color(at(Wrap::black, {0.25f, 1}), {0.5f, 0, 0}); // half way to the black outside
    for (const Wrap wrap : {Wrap::repeat, Wrap::mirror, Wrap::clamp, Wrap::black})
        EXPECT_TRUE(std::isfinite(at(wrap, {1e30f, -1e30f}).r));
    PictureMapping moved;
    moved.scale = {2, 2};
    moved.offset = {0.25f, 0.75f};
    expect_color(PictureTexture(picture(), moved, Rgb(1))({0, 0}), {1, 0, 0});
}

TEST(Picture, OtherFilesAreRefused) {
    for (const std::string& file :
         {std::string("not a picture"), std::string(), picture_file().substr(0, 40)})
        EXPECT_TRUE(mentions(
            refusal([&] {
                Picture(std::span(reinterpret_cast<const unsigned char*>(file.data()), file.size()),
                        "x.png");
            }),
            "x.png: expected a picture"));
}

Scene build(const SceneDescription& description) {
    std::vector<std::string> warnings;
    return build_scene(description, {}, warnings);
}

/// Reflectance of the unit square where (x, y) = (u, v), in whatever scene shows it.
Rgb reflectance_at(const Scene& scene, float x, float y) {
    const auto point = scene.intersect({{x, y, 0.5f}, {0, 0, -1}});
    EXPECT_TRUE(point);
    return point->surface->material->albedo({0, 0, 1}) * point->reflectance();
}

TEST(BaseColor, ComesFromEveryKindOfImage) {
    const TemporaryFolder folder;
    write_bytes(folder / "colours.png", picture_file());
    for (const std::string kind : {"bufferView", "data", "file"}) {
        GltfWriter file = quad();
        file.json["extensionsRequired"] = {"KHR_materials_unlit"}; // shaded all the same
        json image;
        if (kind == "bufferView")
            image = {{"bufferView", file.add_view(picture_file())}, {"mimeType", "image/png"}};
        else if (kind == "data")
            image = {{"uri", "data:image/png;base64," + base64(picture_file())}};
        else
            image = {{"uri", "colours.png"}};
        file.json["images"] = {image};
        file.json["samplers"] = {{{"wrapS", 33071}, {"wrapT", 33648}}};
        file.json["textures"] = {{{"source", 0}, {"sampler", 0}}};
        file.json["materials"] = {
            {{"extensions", {{"KHR_materials_unlit", json::object()}}},
             {"pbrMetallicRoughness",
              {{"baseColorFactor", {0.5, 1, 1, 1}}, {"baseColorTexture", {{"index", 0}}}}}}};
        file.json["meshes"][0]["primitives"][0]["material"] = 0;
        write_bytes(folder / "model.glb", file.glb());
        const GltfModel model = read_gltf(folder / "model.glb");
        EXPECT_EQ(model.parts.at(0).base_color.mapping.wrap_u, Wrap::clamp);
        EXPECT_EQ(model.parts.at(0).base_color.mapping.wrap_v, Wrap::mirror);
        EXPECT_TRUE(has_warning(model, "KHR_materials_unlit"));
        const Scene scene = build(describe_model(folder / "model.glb", {8, 8}));
        expect_color(reflectance_at(scene, 0.25f, 0.75f), {0.5f, 0, 0});
        expect_color(reflectance_at(scene, 0.75f, 0.75f), {0, 1, 0});
    }
}

TEST(BaseColor, IsOnlyForPartsThatWearNothingElse) {
    const TemporaryFolder folder;
    GltfWriter file = quad();
    file.json["materials"] = {
        {{"name", "Body"}, {"pbrMetallicRoughness", {{"baseColorFactor", {0.1, 0.2, 0.3, 1}}}}}};
    write_bytes(folder / "grey.glb", file.glb());
    file.json["meshes"][0]["primitives"][0]["material"] = 0;
    write_bytes(folder / "model.glb", file.glb());
    const auto seen = [&](const std::string& model, const std::string& before) {
        write_bytes(folder / "scene.pbrt",
                    "WorldBegin\n" + before +
                        "\nShape \"gltf\" \"integer level\" 0 \"string filename\" \"" + model +
                        "\"");
        return reflectance_at(build(parse_pbrt(folder / "scene.pbrt")), 0.3f, 0.2f);
    };
    const std::string red = "\"rgb reflectance\" [1 0 0]";
    expect_color(seen("model.glb", ""), {0.1f, 0.2f, 0.3f});
    expect_color(seen("grey.glb", ""), Rgb(0.5f)); // no material: pbrt's default
    expect_color(seen("model.glb", "Material \"diffuse\" " + red), {1, 0, 0});
    expect_color(seen("model.glb", "MakeNamedMaterial \"Body\" \"string type\" \"diffuse\" " + red),
                 {1, 0, 0});
    file.json["materials"][0]["pbrMetallicRoughness"]["baseColorFactor"][1] = 1.5;
    EXPECT_EQ(refusal(file).place, "materials[0].pbrMetallicRoughness.baseColorFactor");
}

TEST(BaseColor, AMissingPictureLeavesTheFactor) {
    GltfWriter file = quad();
    file.json["images"] = {{{"uri", "missing.png"}}};
    file.json["textures"] = {{{"source", 0}}};
    file.json["materials"] = {{{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", 0}}}}}}};
    file.json["meshes"][0]["primitives"][0]["material"] = 0;
    const GltfModel model = read(file.glb());
    EXPECT_EQ(model.parts.at(0).base_color.picture, nullptr);
    EXPECT_EQ(model.parts.at(0).base_color.factor, Rgb(1));
    EXPECT_TRUE(has_warning(model, "textures[0]"));
    file.json["materials"][0]["pbrMetallicRoughness"]["baseColorTexture"]["index"] = 4;
    EXPECT_TRUE(mentions(refusal(file), "one of 1 textures"));
    file.json["materials"][0]["pbrMetallicRoughness"]["baseColorTexture"]["index"] = 0;
    // A picture that lies beyond its buffer.
    file.json["images"] = {{{"bufferView", 0}, {"mimeType", "image/png"}}};
    file.json["bufferViews"][0]["byteLength"] = 1 << 20;
    EXPECT_FALSE(mentions(refusal(file), "accepted"));
}

TEST(ImageMap, IsTheReflectanceOfDiffuse) {
    const TemporaryFolder folder;
    write_bytes(folder / "colours.png", picture_file());
    const auto write = [&](const std::string& texture, const std::string& material) {
        write_bytes(folder / "scene.pbrt",
                    "WorldBegin\nTexture \"print\" \"spectrum\" \"imagemap\" " + texture + "\n" +
                        material +
                        "\nShape \"trianglemesh\" \"point3 P\" [0 0 0 1 0 0 1 1 0 0 1 0] "
                        "\"point2 uv\" [0 0 1 0 1 1 0 1] \"integer indices\" [0 1 2 0 2 3]");
    };
    const std::string file = "\"string filename\" \"colours.png\" ";
    const std::string print = "Material \"diffuse\" \"texture reflectance\" \"print\"";
    const auto seen = [&](float x, float y) {
        return reflectance_at(build(parse_pbrt(folder / "scene.pbrt")), x, y);
    };
    write(file, print);
    expect_color(seen(0.25f, 0.75f), {1, 0, 0});
    expect_color(seen(0.75f, 0.25f), Rgb(0.5f));
    write(file + "\"float scale\" 0.5 \"float uscale\" 2 \"string wrap\" \"clamp\"", print);
    expect_color(seen(0.7f, 0.75f), {0, 0.5f, 0});
    write(file, "MakeNamedMaterial \"m\" \"string type\" \"diffuse\" \"texture reflectance\" "
                "\"print\"\nNamedMaterial \"m\"");
    expect_color(seen(0.25f, 0.25f), {0, 0, 1});

    const auto refused = [&](const std::string& texture, const std::string& material) {
        write(texture, material);
        return refusal([&] { seen(0.5f, 0.5f); });
    };
    EXPECT_TRUE(mentions(refused(file, "Material \"diffuse\" \"texture reflectance\" \"prnt\""),
                         "a known texture: \"print\""));
    EXPECT_TRUE(mentions(refused(file + "\"string wrap\" \"round\"", print), "\"repeat\""));
    EXPECT_TRUE(mentions(refused("", print), "filename"));
    EXPECT_TRUE(mentions(refused("\"string filename\" \"none.png\"", print), "none.png"));
    EXPECT_TRUE(mentions(refused(file + "\"float scale\" 2", print), "[0, 1]"));
    EXPECT_TRUE(mentions(refused(file + "\"float gamma\" 2", print), "udelta"));
}

} // namespace
} // namespace rapport
