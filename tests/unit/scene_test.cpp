#include "renderer/scene/scene.h"

#include "renderer/core/error.h"
#include "renderer/core/rng.h"
#include "renderer/scene/mesh/mesh_operations.h"
#include "renderer/scene/model_scene.h"
#include "renderer/scene/pbrt/pbrt_parser.h"
#include "renderer/scene/scene_builder.h"
#include "renderer/scene/shape/shape.h"
#include "tests/support/gltf_models.h"
#include "tests/support/shared_data.h"
#include "tests/support/small_scenes.h"
#include "tests/support/temporary_folder.h"

#include <fstream>
#include <gtest/gtest.h>

namespace rapport {
namespace {

using tests::level_square;

void expect_near(const glm::vec3& a, const glm::vec3& b, float tolerance = 1e-5f) {
    EXPECT_LT(glm::length(a - b), tolerance) << a.x << ' ' << a.y << ' ' << a.z;
}

Scene scene_of(std::vector<Surface> surfaces) {
    return Scene(std::move(surfaces), {}, Camera{}, RenderSettings{});
}

Frame frame_of(TriangleMesh mesh) {
    std::vector<Surface> surfaces{tests::surface(std::move(mesh), tests::diffuse(0.5f))};
    const auto point = scene_of(std::move(surfaces)).intersect({{0.3f, 0.1f, 5}, {0, 0, -1}});
    EXPECT_TRUE(point);
    return point->frame;
}

TEST(SceneFrame, LiesAlongTheUvs) {
    TriangleMesh mesh = level_square(1, 0);
    const float c = std::cos(0.5f), s = std::sin(0.5f);
    for (size_t i = 0; i < 4; ++i) {
        const glm::vec3 p = mesh.positions[i];
        mesh.uvs[i] = 3.0f * glm::vec2(c * p.x + s * p.y, c * p.y - s * p.x);
    }
    const Frame plain = frame_of(mesh);
    expect_near(plain.x, {c, s, 0});
    expect_near(plain.y, {-s, c, 0});
    expect_near(plain.z, {0, 0, 1});

    // The other side as face: warp stays, weft = warp × normal.
    TriangleMesh reversed = mesh;
    reverse_orientation(reversed);
    const Frame other = frame_of(reversed);
    expect_near(other.x, {-c, -s, 0});
    expect_near(other.y, {-s, c, 0});
    expect_near(other.z, {0, 0, -1});

    // Mirrored UVs: the cloth is not mirrored face-out.
    for (glm::vec2& uv : mesh.uvs)
        uv.x = -uv.x;
    const Frame mirrored = frame_of(mesh);
    expect_near(mirrored.y, plain.y);
    expect_near(mirrored.x, plain.x);
    expect_near(mirrored.z, plain.z);
}

TEST(SceneFrame, SurvivesUvsWithoutAreaAndNormalsAgainstTheWinding) {
    TriangleMesh mesh = level_square(1, 0);
    mesh.uvs.assign(4, {0.5f, 0.5f});
    mesh.normals.assign(4, {0, 0, -1});
    const Frame frame = frame_of(mesh);
    expect_near(frame.z, {0, 0, -1});
    expect_near(glm::cross(frame.x, frame.y), frame.z);
    EXPECT_NEAR(glm::length(frame.x), 1, 1e-6f);
}

TEST(SceneFrame, AReflectedMeshKeepsItsFaceSide) {
    TriangleMesh mesh = level_square(1, 0);
    transform(mesh, glm::scale(glm::mat4(1), glm::vec3(-2, 1, 1)));
    const Frame frame = frame_of(mesh);
    expect_near(frame.z, {0, 0, 1});
    expect_near(frame.y, {0, 1, 0});
}

/// A ray that leaves a surface must not meet the triangle it starts on, at any size and distance
/// from the origin of coordinates.
TEST(SceneOffset, RaysLeaveTheirTriangle) {
    constexpr int kTriangles = 4000;
    int met_with_offset = 0, met_without = 0;
    for (int k = 0; k < kTriangles; ++k) {
        CounterRng rng(1, Purpose::test, 0, static_cast<uint64_t>(k));
        const auto uniform = [&] { return 2 * rng.uniform_float() - 1; };
        const auto vector = [&] { return glm::vec3(uniform(), uniform(), uniform()); };
        const float size = std::pow(10.0f, 4 * uniform()), away = std::pow(10.0f, 4 * uniform());
        TriangleMesh mesh;
        const glm::vec3 centre = away * vector();
        mesh.positions = {centre + size * vector(), centre + size * vector(),
                          centre + size * vector()};
        mesh.triangles = {{0, 1, 2}};
        const glm::vec3 target = (mesh.positions[0] + mesh.positions[1] + mesh.positions[2]) / 3.0f;
        std::vector<Surface> surfaces{tests::surface(mesh, tests::diffuse(0.5f))};
        const Scene scene = scene_of(std::move(surfaces));
        const glm::vec3 from = target + size * vector();
        const auto point = scene.intersect({from, glm::normalize(target - from)});
        if (!point)
            continue; // seen too nearly edge-on
        for (int i = 0; i < 20; ++i) {
            const glm::vec3 direction = glm::normalize(vector());
            met_with_offset +=
                scene.intersect({offset_origin(*point, direction), direction}) ? 1 : 0;
            met_without += scene.intersect({point->position, direction}) ? 1 : 0;
        }
    }
    EXPECT_EQ(met_with_offset, 0);
    EXPECT_GT(met_without, 100); // else the test could not fail
}

TEST(SceneTransmittance, MultipliesTheLayers) {
    std::vector<Surface> surfaces;
    const auto cloth = tests::half_open_cloth();
    for (int i = 1; i <= 3; ++i)
        surfaces.push_back(tests::surface(level_square(1, static_cast<float>(i)), cloth));
    const Scene scene = scene_of(surfaces);
    const auto sun = tests::sun(1, {0, 0, 1});
    const auto passed = [&](const Scene& s, const glm::vec3& from, float z, float distance) {
        return s.transmittance(from, {0, 0, z}, distance, *sun).g;
    };
    const glm::vec3 below(0.2f, 0.3f, 0), above(0.2f, 0.3f, 4);
    EXPECT_NEAR(passed(scene, below, 1, 10), 0.125f, 1e-5f);
    EXPECT_NEAR(passed(scene, above, -1, 10), 0.125f, 1e-5f);
    EXPECT_NEAR(passed(scene, below, 1, 2.5f), 0.25f, 1e-5f);
    EXPECT_EQ(passed(scene, below, -1, 10), 1);

    surfaces.push_back(tests::surface(level_square(1, 3.5f), tests::diffuse(0.5f)));
    EXPECT_EQ(passed(scene_of(surfaces), below, 1, 10), 0);
}

TEST(SceneLights, AreChosenHalfByPowerAndHalfUniformly) {
    std::vector<Surface> surfaces{tests::surface(level_square(1, 0), tests::diffuse(0), 3),
                                  tests::surface(level_square(1, 5), tests::diffuse(0), 1),
                                  tests::surface(level_square(1, 7), tests::diffuse(0), 0)};
    surfaces[1].two_sided_emission = true;
    const Scene scene = scene_of(std::move(surfaces));
    EXPECT_EQ(scene.surfaces()[2].area_light, nullptr);
    EXPECT_NEAR(scene.choice_probability(*scene.surfaces()[0].area_light), 0.55f, 1e-6f);
    EXPECT_NEAR(scene.choice_probability(*scene.surfaces()[1].area_light), 0.45f, 1e-6f);
    EXPECT_EQ(scene.choose_light(0.54f)->light, scene.surfaces()[0].area_light.get());
    EXPECT_EQ(scene.choose_light(0.56f)->light, scene.surfaces()[1].area_light.get());
    EXPECT_FALSE(scene_of({}).choose_light(0.5f));
}

TEST(SceneLights, AConstantSkyIsLeftToScattering) {
    const Scene scene({}, {tests::sky(2)}, Camera{}, RenderSettings{});
    EXPECT_FALSE(scene.choose_light(0.5f));
    ASSERT_EQ(scene.distant_lights().size(), 1u);
    EXPECT_EQ(scene.distant_lights()[0].probability, 0);
    EXPECT_EQ(scene.distant_lights()[0].light->escaped({0, 0, 1}).radiance, Rgb(2));
}

TEST(Registries, HoldWhatIsShipped) {
    EXPECT_EQ(LightRegistry::instance().names(),
              (std::vector<std::string>{"distant", "infinite", "point", "spot"}));
    EXPECT_EQ(
        ShapeRegistry::instance().names(),
        (std::vector<std::string>{"disk", "fibers", "gltf", "plymesh", "sphere", "trianglemesh"}));
}

class SceneBuilder : public testing::Test {
  protected:
    Scene build(const std::string& world, const BuildOptions& options = {}) {
        const std::filesystem::path path = folder_ / "scene.pbrt";
        std::ofstream(path) << "WorldBegin\n" << world;
        std::vector<std::string> warnings;
        return build_scene(parse_pbrt(path), options, warnings);
    }
    std::string refusal(const std::string& world, const BuildOptions& options = {}) {
        try {
            build(world, options);
        } catch (const FileError& error) {
            return error.what();
        }
        ADD_FAILURE() << "was accepted: " << world;
        return "";
    }
    tests::TemporaryFolder folder_;
};

constexpr const char* kTriangle = R"(Shape "trianglemesh" "point3 P" [0 0 0 1 0 0 0 1 0] )";

TEST_F(SceneBuilder, BuildsTrianglesLightsAndEmission) {
    const Scene scene = build(std::string(R"(
        LightSource "infinite" "rgb L" [1 2 3] "float scale" 2
        Material "diffuse" "rgb reflectance" [.2 .4 .6]
        AreaLightSource "diffuse" "rgb L" [4 4 4]
        Scale 1 1 -1
        ReverseOrientation )") +
                              kTriangle);
    ASSERT_EQ(scene.surfaces().size(), 1u);
    const Surface& surface = scene.surfaces()[0];
    EXPECT_EQ(surface.emission, Rgb(4));
    EXPECT_EQ(surface.material->albedo({0, 0, 1}), Rgb(.2f, .4f, .6f));
    ASSERT_EQ(scene.distant_lights().size(), 1u);
    EXPECT_EQ(scene.distant_lights()[0].light->escaped({0, 0, 1}).radiance, Rgb(2, 4, 6));
    // Reflected, its face is −z; reversed, +z again.
    const auto point = scene.intersect({{.2f, .2f, 1}, {0, 0, -1}});
    ASSERT_TRUE(point);
    expect_near(point->geometric_normal, {0, 0, 1});
}

TEST_F(SceneBuilder, RefusesWithChoices) {
    const auto contains = [](const std::string& text, const std::string& part) {
        EXPECT_NE(text.find(part), std::string::npos) << text;
    };
    contains(refusal("LightSource \"goniometric\""), "distant, infinite");
    contains(refusal("Shape \"cylinder\""), "gltf, plymesh, sphere");
    contains(refusal("Material \"velvet\"\n" + std::string(kTriangle)), "diffuse");
    contains(refusal(std::string(kTriangle) + "\"float radius\" 1"), "indices");
    contains(refusal(std::string(kTriangle) + "\"integer indices\" [0 1 3]"), "from 0 to 2");
    contains(refusal(std::string(kTriangle) + "\"integer indices\" [0 1]"), "three indices");
    contains(refusal(std::string(kTriangle) + "\"normal N\" [0 0 1]"), "3 vertices");
    contains(refusal("Shape \"trianglemesh\""), "point3 P");
    contains(refusal("LightSource \"infinite\" \"rgb L\" [1 1 -1]"), "0 or more");
    contains(refusal("LightSource \"infinite\" \"rgb L\" 1 1 1"), "");
    contains(refusal("LightSource \"distant\" \"point3 from\" [0 0 1]"), "apart");
    contains(refusal("LightSource \"spot\" \"point3 from\" [0 0 1]"), "apart");
    contains(refusal("LightSource \"spot\" \"float coneangle\" 0"), "180 degrees");
    contains(refusal("LightSource \"point\" \"rgb I\" [-1 1 1]"), "0 or more");
    contains(refusal("AreaLightSource \"diffuse\" \"rgb M\" [1 1 1]\n" + std::string(kTriangle)),
             "twosided");
    contains(refusal("Shape \"plymesh\" \"string filename\" \"absent.ply\""), "absent.ply");
    contains(refusal("Shape \"gltf\" \"string filename\" \"absent.glb\""), "absent.glb");
    contains(refusal("LightSource \"infinite\" \"string filename\" \"absent.exr\""), "absent.exr");
    contains(refusal(kTriangle, {{{"Body", "satin.bsdf"}}, {}, {}}), "Body");
    contains(refusal(kTriangle, {{}, {}, {{"Body", "navy"}}}), "a cloth for each");
    contains(refusal(kTriangle, {{{"", "satin.bsdf"}}, {}, {}}), "a glTF shape to wear the cloth");
    contains(
        refusal("MakeNamedMaterial \"Body\" \"string type\" \"diffuse\"\n" + std::string(kTriangle),
                {{{"Body", "satin.bsdf"}}, {}, {}}),
        "a shape that wears \"Body\"");
}

TEST_F(SceneBuilder, RefusesWithThePlaceInTheScene) {
    const auto refused = [&](const std::string& world, const std::string& part) {
        const std::string message = refusal(world);
        EXPECT_NE(message.find(part), std::string::npos) << message;
    };
    std::ofstream(folder_ / "torn.png") << "\x89PNG";
    const std::string texture = "Texture \"t\" \"spectrum\" \"imagemap\" ";
    for (const std::string shape : {"", kTriangle}) { // used or not
        refused("Material \"velvet\"\n" + shape, "scene.pbrt:2:10: expected a material");
        refused("Material \"diffuse\" \"float gloss\" 1\n" + shape, "scene.pbrt:2:20: ");
        refused("AreaLightSource \"diffuse\" \"float M\" 1\n" + shape, "scene.pbrt:2:27: ");
    }
    refused("MakeNamedMaterial \"a\" \"string type\" \"velvet\"",
            "scene.pbrt:2:23: expected a mat");
    refused("LightSource \"sun\"", "scene.pbrt:2:13: expected a light");
    refused("Shape \"torus\"", "scene.pbrt:2:7: expected a shape");
    refused("ObjectBegin \"o\"\nShape \"torus\"\nObjectEnd", "scene.pbrt:3:7: expected a shape");
    refused(texture + "\"string filname\" \"a.png\"", "scene.pbrt:2:9: ");
    refused(texture + "\"string filename\" \"a.png\" \"float uscal\" 1", "scene.pbrt:2:61: ");
    for (const char* const file : {"absent.png", "torn.png"})
        refused(texture + "\"string filename\" \"" + file + "\"", "scene.pbrt:2:9)");
    refused("LightSource \"infinite\" \"string filename\" \"absent.exr\"", "scene.pbrt:2:13)");
    refused("Shape \"gltf\" \"string filename\" \"absent.glb\"", "scene.pbrt:2:7)");
    // What nothing wears needs no table, for the caller may have replaced it.
    build("Material \"cloth\" \"string filename\" \"absent.bsdf\"");
}

TEST_F(SceneBuilder, RefusesWhatSinglePrecisionCannotTrace) {
    const auto refused = [&](const std::string& world, const std::string& expected) {
        EXPECT_NE(refusal(world).find("scene.pbrt:3:7" + expected), std::string::npos)
            << refusal(world);
    };
    tests::write_bytes(folder_ / "model.glb", tests::quad().glb());
    const std::string light = " AreaLightSource \"diffuse\"\n",
                      far = "1 0 0 0  0 1 0 0  0 0 1 0  0 0 1e18 1]\n";
    for (const std::string shape : {kTriangle, "Shape \"disk\"", "Shape \"sphere\"",
                                    "Shape \"gltf\" \"string filename\" \"model.glb\""}) {
        refused("Scale 1e20 1e20 1e20\n" + shape, ": expected positions below 1e18");
        refused("ConcatTransform [" + far + shape, ": expected positions below 1e18");
        refused("Scale 1e17 1e17 1e17" + light + shape, ": expected an area light");
    }
    refused("AreaLightSource \"diffuse\" \"rgb L\" [1e38 1e38 1e38] Scale 9 9 9\n" +
                std::string(kTriangle),
            ": expected an area light");
    EXPECT_EQ(build("Scale 1e9 1e9 1e9" + light + kTriangle).surfaces().size(), 1u);
}

TEST_F(SceneBuilder, AClothNeedsUvs) {
    const std::string cloth = "Material \"cloth\" \"string filename\" \"a.bsdf\"\n";
    BuildOptions options;
    options.load_table = [](const std::filesystem::path& path, const std::string& colourway) {
        EXPECT_EQ(path.filename(), "a.bsdf");
        EXPECT_EQ(colourway, "");
        return std::make_shared<const TableBsdf>(
            tests::synthetic_table([](const auto&, const auto&, size_t) { return 0.0; }, 0.5),
            "a.bsdf");
    };
    EXPECT_NE(refusal(cloth + kTriangle, options).find("UVs"), std::string::npos);
    const Scene scene = build(cloth + kTriangle + "\"point2 uv\" [0 0 1 0 0 1]", options);
    EXPECT_NEAR(scene.surfaces()[0].material->unscattered({0, 0, 1}).r, 0.5f, 1e-6f);
    // Replaced from outside, by name.
    options.cloths["skirt"] = "a.bsdf";
    const Scene replaced = build("MakeNamedMaterial \"skirt\" \"string type\" \"diffuse\"\n"
                                 "NamedMaterial \"skirt\"\n" +
                                     std::string(kTriangle) + "\"point2 uv\" [0 0 1 0 0 1]",
                                 options);
    EXPECT_NEAR(replaced.surfaces()[0].material->unscattered({0, 0, 1}).r, 0.5f, 1e-6f);
}

TEST(ModelScene, FramesTheWholeModel) {
    RAPPORT_SHARED_DATA_OR_SKIP(data);
    const SceneDescription description =
        describe_model(data / "gltf/Corset/Corset.gltf", {300, 200});
    std::vector<std::string> warnings;
    const Scene scene = build_scene(description, {}, warnings);
    ASSERT_FALSE(scene.surfaces().empty());
    const glm::mat4 to_camera = glm::inverse(scene.camera.to_world);
    EXPECT_LT(glm::determinant(to_camera), 0); // right-handed geometry is not mirrored
    const float t = std::tan(radians(scene.camera.fov_degrees) / 2);
    float fill = 0;
    for (const Surface& surface : scene.surfaces())
        for (const glm::vec3& p : surface.mesh->positions) {
            const glm::vec3 c(to_camera * glm::vec4(p, 1));
            if (surface.emission != Rgb(0)) { // the lamp stays out of the picture
                ASSERT_LT(c.z, 0);
                continue;
            }
            ASSERT_GT(c.z, 0);
            fill = std::max({fill, std::abs(c.x) / c.z / (1.5f * t), std::abs(c.y) / c.z / t});
        }
    EXPECT_LT(fill, 1.0f);
    EXPECT_GT(fill, 0.8f);
}

} // namespace
} // namespace rapport
