#include "materials/bsdf.h"
#include "renderer/core/error.h"
#include "renderer/core/fresnel.h"
#include "renderer/integrator/path_tracer.h"
#include "renderer/scene/pbrt/pbrt_parser.h"
#include "renderer/scene/scene_builder.h"
#include "tests/support/file_bytes.h"
#include "tests/support/small_scenes.h"
#include "tests/support/temporary_folder.h"

#include <gtest/gtest.h>
#include <limits>

// Metal and glass, point and spot lights, spheres and disks: against what is known in closed form.

namespace rapport {
namespace {

using namespace tests;

std::shared_ptr<const Bsdf> material(const std::string& name, const std::vector<Param>& list) {
    Params params("test", name, 1);
    for (const Param& param : list)
        params.add(param);
    return make_material(name, {params, "", {}});
}

const glm::vec3 kEye = glm::normalize(glm::vec3(0.3f, -0.5f, 0.8f));

TEST(Conductor, MirrorsByFresnel) {
    const auto mirror =
        material("conductor", {number_param("rgb", "reflectance", {0.2, 0.5, 0.9})});
    for (const float side : {1.0f, -1.0f}) {
        const auto normal = mirror->sample({0, 0, side}, 0, {0.5f, 0.5f});
        ASSERT_TRUE(normal);
        EXPECT_EQ(normal->pdf, kMirror);
        EXPECT_LT(glm::distance(normal->weight, Rgb(0.2f, 0.5f, 0.9f)), 1e-5f);
        const auto slanted = mirror->sample(glm::vec3(kEye.x, kEye.y, side * kEye.z), 0, {});
        EXPECT_EQ(slanted->light, glm::vec3(-kEye.x, -kEye.y, side * kEye.z));
    }
    EXPECT_EQ(mirror->eval(kEye, glm::vec3(-kEye.x, -kEye.y, kEye.z)), Rgb(0));
    EXPECT_NEAR(mirror->sample(glm::normalize(glm::vec3(1, 0, 1e-3f)), 0, {})->weight.r, 1, 0.01);
    // Without absorption it is the dielectric's Fresnel.
    const auto clear = material("conductor", {number_param("rgb", "eta", {1.5, 1.5, 1.5}),
                                              number_param("rgb", "k", {0, 0, 0})});
    EXPECT_NEAR(clear->sample(kEye, 0, {})->weight.g,
                fresnel_dielectric(kEye.z, 1 / 1.5).reflectance, 1e-5);
}

TEST(Conductor, RoughReflectionIsReciprocalAndNearTheMirrorWhenSmooth) {
    const auto rough = material("conductor", {number_param("float", "roughness", {0.3})});
    const glm::vec3 light = glm::normalize(glm::vec3(-0.6f, 0.1f, 0.5f));
    const Rgb there = rough->eval(kEye, light) / light.z, back = rough->eval(light, kEye) / kEye.z;
    EXPECT_LT(glm::distance(there, back), 1e-5f * glm::length(there));
    EXPECT_EQ(rough->eval(kEye, -light), Rgb(0));
    const auto nearly = material(
        "conductor", {number_param("float", "roughness", {0.01}),
                      {.type = "bool", .name = "remaproughness", .numbers = {0}, .strings = {}}});
    for (const float u : {0.1f, 0.5f, 0.9f})
        EXPECT_LT(glm::distance(nearly->sample(kEye, 0, {u, u})->light,
                                glm::vec3(-kEye.x, -kEye.y, kEye.z)),
                  0.1f);
}

TEST(Dielectric, ReflectsAndRefractsByFresnelAndSnell) {
    const auto glass = material("dielectric", {});
    for (const float side : {1.0f, -1.0f}) {
        const glm::vec3 eye(kEye.x, kEye.y, side * kEye.z);
        const double eta = side > 0 ? 1 / 1.5 : 1.5;
        const double reflected = fresnel_dielectric(kEye.z, eta).reflectance;
        const auto mirrored = glass->sample(eye, static_cast<float>(reflected) - 1e-3f, {});
        EXPECT_EQ(mirrored->light, glm::vec3(-eye.x, -eye.y, eye.z));
        if (reflected == 1)
            continue;
        const auto through = glass->sample(eye, static_cast<float>(reflected) + 1e-3f, {});
        EXPECT_LT(through->light.z * eye.z, 0);
        EXPECT_NEAR(glm::length(glm::vec2(through->light)), eta * glm::length(glm::vec2(eye)),
                    1e-6);
        EXPECT_EQ(through->weight, Rgb(1));
    }
    EXPECT_THROW(material("dielectric", {number_param("float", "roughness", {1.1})}), FileError);
    EXPECT_THROW(material("dielectric", {number_param("float", "uroughness", {-1})}), FileError);
    EXPECT_THROW(material("dielectric", {number_param("float", "eta", {0})}), FileError);
    EXPECT_THROW(material("conductor", {number_param("rgb", "reflectance", {1, 1, 1})}), FileError);
}

TEST(Dielectric, RoughScatteringIsReciprocalAndNearSnellWhenSmooth) {
    const auto rough = material("dielectric", {number_param("float", "uroughness", {0.3}),
                                               number_param("float", "vroughness", {0.1})});
    const glm::vec3 above = glm::normalize(glm::vec3(-0.6f, 0.1f, 0.5f));
    const glm::vec3 below = glm::normalize(glm::vec3(-0.2f, 0.3f, -0.9f));
    const float reflected = rough->eval(kEye, above).g / above.z;
    EXPECT_GT(reflected, 0);
    EXPECT_NEAR(rough->eval(above, kEye).g / kEye.z, reflected, 1e-5f * reflected);
    // Radiance over the square of the index: f / n² of the light's side is the same both ways.
    const float refracted = rough->eval(kEye, below).g / -below.z / square(1.5f);
    EXPECT_GT(refracted, 0);
    EXPECT_NEAR(rough->eval(below, kEye).g / kEye.z, refracted, 1e-5f * refracted);

    const auto glass = material("dielectric", {});
    const auto nearly = material(
        "dielectric", {number_param("float", "roughness", {0.005}),
                       {.type = "bool", .name = "remaproughness", .numbers = {0}, .strings = {}}});
    for (const float side : {1.0f, -1.0f})
        for (const float choice : {0.0f, 0.999f}) {
            const glm::vec3 eye = glm::normalize(glm::vec3(0.2f, -0.3f, side));
            for (const float u : {0.1f, 0.5f, 0.9f})
                EXPECT_LT(glm::distance(nearly->sample(eye, choice, {u, u})->light,
                                        glass->sample(eye, choice, {})->light),
                          0.05f);
        }
    // Equal indices do nothing, however rough the boundary between them.
    const auto none = material("dielectric", {number_param("float", "eta", {1}),
                                              number_param("float", "roughness", {0.3})});
    EXPECT_LT(glm::distance(none->sample(kEye, 0, {})->light, -kEye), 1e-6f);
}

TEST(Conductor, IsSmoothAlongItsGrooves) {
    const auto brushed = material("conductor", {number_param("float", "uroughness", {0.01}),
                                                number_param("float", "vroughness", {0.5})});
    const float tilt = 0.4f;
    const Rgb along = brushed->eval({0, 0, 1}, {std::sin(tilt), 0, std::cos(tilt)});
    const Rgb across = brushed->eval({0, 0, 1}, {0, std::sin(tilt), std::cos(tilt)});
    EXPECT_GT(across.g, 10 * along.g);
}

/// A scene file's picture: mean of R with its standard error.
struct Seen {
    double mean, error;
};
Seen seen(const std::string& scene,
          const std::string& camera = "LookAt 0 -6 0 0 0 0 0 0 1 Camera "
                                      "\"perspective\" \"float fov\" 15 ") {
    const TemporaryFolder folder;
    write_bytes(folder / "scene.pbrt",
                camera +
                    "Film \"rgb\" \"integer xresolution\" 24 \"integer yresolution\" 24 "
                    "Sampler \"independent\" \"integer pixelsamples\" 64 "
                    "Integrator \"path\" \"integer maxdepth\" 100 WorldBegin " +
                    scene);
    std::vector<std::string> warnings;
    const Image image =
        render(build_scene(parse_pbrt(folder / "scene.pbrt"), {}, warnings)).image();
    Seen seen{0, 0};
    for (const float r : *image.find("R"))
        seen.mean += r;
    for (const float v : *image.find("variance.R"))
        seen.error += v;
    const double count = image.width * image.height;
    return {seen.mean / count, std::sqrt(seen.error) / count + 1e-6};
}

TEST(Furnace, AGlassSphereVanishes) {
    const std::string sky = "LightSource \"infinite\" \"rgb L\" [1 1 1] ";
    const Seen glass = seen(sky + "Material \"dielectric\" Shape \"sphere\"");
    EXPECT_NEAR(glass.mean, 1, 4 * glass.error + 1e-4);
    const Seen metal = seen(sky + "Material \"conductor\" \"rgb reflectance\" [.5 .5 .5] "
                                  "Shape \"sphere\"");
    EXPECT_LT(metal.mean, 0.8);
}

/// Emitters are seen in mirrors and through glass, whose directions no light sample finds.
TEST(Mirrors, ShowEmittersInFull) {
    // A camera looks down on a mirror, above both a ceiling that shines with radiance 2.
    const std::string light = "AttributeBegin Material \"diffuse\" \"rgb reflectance\" [0 0 0] "
                              "AreaLightSource \"diffuse\" \"rgb L\" [2 2 2] "
                              "Translate 0 0 9 Rotate 180 1 0 0 Shape \"disk\" \"float radius\" 90 "
                              "AttributeEnd ";
    const std::string camera = "LookAt 0 0 6 0 0 0 0 1 0 Camera \"perspective\" \"float fov\" 15 ";
    const Seen mirror = seen(light + "Material \"conductor\" \"rgb reflectance\" [.5 .5 .5] "
                                     "Shape \"disk\" \"float radius\" 9",
                             camera);
    EXPECT_NEAR(mirror.mean, 1, 0.01 + 4 * mirror.error); // Fresnel within 7.5° of the normal
}

TEST(PointLight, FallsOffWithTheSquareOfTheDistance) {
    // Irradiance I/d² on a white ground, seen from above through a narrow lens: E/π.
    const std::string camera = "LookAt 0 0 6 0 0 0 0 1 0 Camera \"perspective\" \"float fov\" 0.5 ";
    const std::string ground = "Material \"diffuse\" \"rgb reflectance\" [1 1 1] Shape \"disk\" "
                               "\"float radius\" 50 ";
    for (const double height : {1.0, 3.0}) {
        const Seen ground_lit =
            seen(ground + "LightSource \"point\" \"rgb I\" [7 7 7] \"point3 from\" [0 0 " +
                     std::to_string(height) + "]",
                 camera);
        EXPECT_NEAR(ground_lit.mean, 7 / square(height) / kPi, 2e-3 * ground_lit.mean);
    }
    const Seen spot =
        seen(ground + "LightSource \"spot\" \"rgb I\" [7 7 7] \"point3 from\" [0 0 2] "
                      "\"point3 to\" [0 0 0]",
             camera);
    EXPECT_NEAR(spot.mean, 7 / 4.0 / kPi, 2e-3 * spot.mean);
    // 30° off the axis it is dark; half way through the edge, in cosθ, half as bright.
    const auto tilted = [&](double degrees) {
        return seen(ground + "Translate 0 0 2 Rotate " + std::to_string(degrees) +
                        " 1 0 0 LightSource \"spot\" \"rgb I\" [7 7 7] \"point3 to\" [0 0 -1]",
                    camera)
            .mean;
    };
    EXPECT_EQ(tilted(31), 0);
    const double middle =
        degrees(std::acos(0.5 * (std::cos(radians(30.0)) + std::cos(radians(25.0)))));
    EXPECT_NEAR(tilted(middle), spot.mean / 2, 0.05 * spot.mean);
}

TEST(ImageLight, IsBlackWhereItsFileIsNegativeAndSaysSo) {
    const TemporaryFolder folder;
    Image image(8, 4, {"R", "G", "B"});
    for (auto& plane : image.data)
        plane.assign(plane.size(), 1);
    image.data[0][5] = image.data[1][5] = image.data[2][9] = -0.5f;
    write_exr(image, folder / "sky.exr");
    write_bytes(folder / "scene.pbrt",
                "WorldBegin LightSource \"infinite\" \"string filename\" \"sky.exr\"");
    std::vector<std::string> warnings;
    const Scene scene = build_scene(parse_pbrt(folder / "scene.pbrt"), {}, warnings);
    ASSERT_EQ(warnings.size(), 1u);
    EXPECT_NE(warnings[0].find("in 2 of 32 pixels"), std::string::npos) << warnings[0];
    for (const float z : {1.0f, 0.5f, 0.0f, -1.0f})
        EXPECT_TRUE(glm::all(glm::greaterThanEqual(
            scene.lights()[0]->escaped(glm::normalize(glm::vec3(0.3f, 0.4f, z))).radiance,
            Rgb(0))));
    image.data[0][5] = std::numeric_limits<float>::quiet_NaN();
    write_exr(image, folder / "sky.exr");
    EXPECT_THROW(build_scene(parse_pbrt(folder / "scene.pbrt"), {}, warnings), FileError);
}

TEST(SpotLight, ItsPowerIsTheIntegralOfItsIntensity) {
    Params params("test", "spot", 1);
    params.add(number_param("float", "coneangle", {40}));
    params.add(number_param("float", "conedeltaangle", {20}));
    const auto light = make_light("spot", {params, "", glm::mat4(1)});
    double sum = 0;
    constexpr int kSteps = 20000;
    for (int i = 0; i < kSteps; ++i) {
        const double cosine = -1 + 2 * (i + 0.5) / kSteps;
        const auto one =
            light->sample(-3.0f * glm::vec3(spherical_direction(std::acos(-cosine), 0.0)), {});
        sum += one ? 9 * one->radiance.g * 4 * kPi / kSteps : 0;
    }
    EXPECT_NEAR(light->power(), sum, 1e-3 * sum);
}

TEST(SphereShape, HasItsAreaAndFrames) {
    const TemporaryFolder folder;
    const auto mesh = [&](const std::string& shape) {
        write_bytes(folder / "scene.pbrt", "WorldBegin Shape " + shape);
        std::vector<std::string> warnings;
        return *build_scene(parse_pbrt(folder / "scene.pbrt"), {}, warnings).surfaces().at(0).mesh;
    };
    const auto area = [](const TriangleMesh& m) {
        double sum = 0;
        for (const glm::uvec3& t : m.triangles)
            sum += 0.5 * glm::length(glm::cross(m.positions[t.y] - m.positions[t.x],
                                                m.positions[t.z] - m.positions[t.x]));
        return sum;
    };
    const TriangleMesh whole = mesh("\"sphere\" \"float radius\" 2");
    EXPECT_NEAR(area(whole), 16 * kPi, 16 * kPi * 3e-3);
    for (size_t v = 0; v < whole.positions.size(); ++v) {
        EXPECT_NEAR(glm::length(whole.positions[v]), 2, 1e-6);
        EXPECT_NEAR(glm::dot(glm::cross(whole.weft[v], whole.warp[v]), whole.normals[v]), 1, 1e-5);
    }
    for (const glm::uvec3& t : whole.triangles) // faces outwards
        EXPECT_GT(glm::dot(glm::cross(whole.positions[t.y] - whole.positions[t.x],
                                      whole.positions[t.z] - whole.positions[t.x]),
                           whole.positions[t.x]),
                  0);
    const TriangleMesh belt =
        mesh("\"sphere\" \"float zmin\" -0.5 \"float zmax\" 0.25 \"float phimax\" 90");
    EXPECT_NEAR(area(belt), kPi / 2 * 0.75, 3e-3);
    const TriangleMesh ring = mesh("\"disk\" \"float innerradius\" 0.5 \"float height\" 3");
    EXPECT_NEAR(area(ring), 0.75 * kPi, 5e-3);
    EXPECT_EQ(ring.positions[0].z, 3);
    const auto refused = [&](const std::string& shape) {
        EXPECT_THROW(mesh(shape), FileError) << shape;
    };
    refused("\"sphere\" \"float radius\" 0");
    refused("\"sphere\" \"float zmin\" 1 \"float zmax\" 0");
    refused("\"sphere\" \"float phimax\" 400");
    refused("\"disk\" \"float innerradius\" 2");
}

} // namespace
} // namespace rapport
