#include "renderer/scene/pbrt/pbrt_parser.h"

#include "renderer/core/error.h"
#include "tests/support/temporary_folder.h"

#include <fstream>
#include <gtest/gtest.h>

namespace rapport {
namespace {

class PbrtParser : public testing::Test {
  protected:
    std::filesystem::path write(const std::string& name, const std::string& text) {
        const std::filesystem::path path = folder_ / name;
        std::ofstream(path, std::ios::binary) << text;
        return path;
    }
    SceneDescription parse(const std::string& text) {
        return parse_pbrt(write("scene.pbrt", text));
    }
    SceneDescription parse_world(const std::string& text) { return parse("WorldBegin\n" + text); }

    tests::TemporaryFolder folder_;
};

void expect_near(const glm::vec3& a, const glm::vec3& b) {
    EXPECT_LT(glm::length(a - b), 1e-5f) << a.x << ' ' << a.y << ' ' << a.z;
}

TEST_F(PbrtParser, ReadsOptions) {
    const SceneDescription scene = parse(R"(
        # a comment with "quotes" and [brackets]
        LookAt 1 2 3  4 5 6  0 0 1
        Camera "orthographic" "float screenwindow" [-2 2 -1 1]
        Film "rgb" "integer xresolution" 320 "integer yresolution" [200]
             "string filename" "out\\\"put.exr"
        Sampler "zsobol" "integer pixelsamples" 64 "integer seed" 7
        PixelFilter "box" "float xradius" 0.25
        Integrator "path" "integer maxdepth" 0
        ColorSpace "srgb"
        WorldBegin)");
    EXPECT_EQ(scene.camera.kind, Camera::Kind::orthographic);
    EXPECT_EQ(scene.camera.screen_window, glm::vec4(-2, 2, -1, 1));
    EXPECT_EQ(scene.camera.resolution, glm::ivec2(320, 200));
    EXPECT_EQ(scene.settings.output, "out\\\"put.exr");
    EXPECT_EQ(scene.settings.samples, 64);
    EXPECT_EQ(scene.settings.seed, 7u);
    EXPECT_EQ(scene.settings.sampler, Sampler::Kind::sobol);
    EXPECT_EQ(scene.settings.filter_radius, glm::vec2(0.25f, 0.5f));
    EXPECT_EQ(scene.settings.max_depth, 0);
}

// pbrt's LookAt: x = up × direction, y = direction × x, z = direction.
TEST_F(PbrtParser, LooksAtLikePbrt) {
    const glm::mat4 m =
        parse("LookAt 0 -5 0  0 0 0  0 0 1\nCamera \"perspective\"\nWorldBegin").camera.to_world;
    expect_near(glm::vec3(m[0]), {-1, 0, 0});
    expect_near(glm::vec3(m[1]), {0, 0, 1});
    expect_near(glm::vec3(m[2]), {0, 1, 0});
    expect_near(glm::vec3(m[3]), {0, -5, 0});
}

TEST_F(PbrtParser, ComposesTransformations) {
    const SceneDescription scene = parse(R"(
        Scale -1 1 1
        Translate 0 0 2
        Camera "perspective"
        WorldBegin
        AttributeBegin
          Translate 1 0 0  Rotate 90  0 0 1  Scale 2 2 2
          CoordinateSystem "here"
          Shape "plymesh"
        AttributeEnd
        Shape "plymesh"
        TransformBegin
          CoordSysTransform "here"
          ConcatTransform [1 0 0 0  0 1 0 0  0 0 1 0  0 0 5 1]
          Shape "plymesh"
          Transform [1 0 0 0  0 1 0 0  0 0 1 0  3 4 5 1]
          Shape "plymesh"
          CoordSysTransform "camera"
          Shape "plymesh"
        TransformEnd
        Shape "plymesh")");
    const auto image_of = [&](size_t shape, const glm::vec3& p) {
        return glm::vec3(scene.shapes.at(shape).to_world * glm::vec4(p, 1));
    };
    expect_near(image_of(0, {1, 0, 0}), {1, 2, 0});
    expect_near(image_of(1, {1, 0, 0}), {1, 0, 0});
    expect_near(image_of(2, {1, 0, 0}), {1, 2, 10});
    expect_near(image_of(3, {0, 0, 0}), {3, 4, 5});
    expect_near(image_of(4, {1, 0, 0}), {-1, 0, -2}); // camera to world
    expect_near(image_of(5, {1, 2, 3}), {1, 2, 3});
    expect_near(glm::vec3(scene.camera.to_world[3]), {0, 0, -2});
}

TEST_F(PbrtParser, PlacesInstancesOfObjects) {
    const SceneDescription scene = parse_world(R"(
        Translate 0 0 1
        ObjectBegin "pair"
          Material "diffuse" "rgb reflectance" [.1 .2 .3]
          Translate 1 0 0
          Shape "sphere"
          ReverseOrientation
          Shape "disk"
        ObjectEnd
        Shape "plymesh"
        AttributeBegin
          Scale 2 2 2
          ObjectInstance "pair"
        AttributeEnd
        ObjectInstance "pair")");
    ASSERT_EQ(scene.shapes.size(), 5u); // an object alone shows nothing
    EXPECT_EQ(scene.shapes[0].type, "plymesh");
    EXPECT_EQ(scene.shapes[0].material, nullptr);
    EXPECT_EQ(scene.shapes[2].type, "disk");
    EXPECT_TRUE(scene.shapes[2].reverse_orientation);
    EXPECT_FALSE(scene.shapes[1].reverse_orientation);
    EXPECT_EQ(scene.shapes[4].material->type, "diffuse");
    const auto origin_of = [&](size_t shape) { return glm::vec3(scene.shapes[shape].to_world[3]); };
    expect_near(origin_of(1), {2, 0, 3}); // the instance's transform after that of the definition
    expect_near(origin_of(4), {1, 0, 2});
}

TEST_F(PbrtParser, KeepsAttributesInTheirScope) {
    const SceneDescription scene = parse_world(R"(
        MakeNamedMaterial "body" "string type" "cloth" "string filename" "satin.bsdf"
        AttributeBegin
          Material "diffuse" "rgb reflectance" [.1 .2 .3]
          AreaLightSource "diffuse" "rgb L" [1 2 3] "bool twosided" true
          ReverseOrientation
          Shape "trianglemesh" "point3 P" [0 0 0 1 0 0 0 1 0]
        AttributeEnd
        NamedMaterial "body"
        Shape "gltf" "string filename" "model.glb"
        LightSource "distant" "point3 from" [0 0 1])");
    ASSERT_EQ(scene.shapes.size(), 2u);
    const ShapeDescription &inside = scene.shapes[0], &outside = scene.shapes[1];
    EXPECT_EQ(inside.material->type, "diffuse");
    EXPECT_EQ(inside.material->params.get_rgb("reflectance", Rgb(0)), Rgb(.1f, .2f, .3f));
    EXPECT_TRUE(inside.reverse_orientation);
    ASSERT_TRUE(inside.area_light.has_value());
    EXPECT_TRUE(inside.area_light->get_bool("twosided", false));
    EXPECT_EQ(inside.params.get_point3s("P").size(), 3u);
    EXPECT_EQ(outside.material->type, "cloth");
    EXPECT_EQ(outside.material->name, "body");
    EXPECT_FALSE(outside.reverse_orientation);
    EXPECT_FALSE(outside.area_light.has_value());
    ASSERT_EQ(scene.lights.size(), 1u);
    EXPECT_EQ(scene.lights[0].type, "distant");
}

TEST_F(PbrtParser, IncludesFilesBesideTheScene) {
    write("part.pbrt", "Translate 1 0 0\nShape \"plymesh\"\n");
    const SceneDescription scene = parse_world("Include \"part.pbrt\"\nInclude \"part.pbrt\"");
    ASSERT_EQ(scene.shapes.size(), 2u);
    EXPECT_FLOAT_EQ(scene.shapes[1].to_world[3].x, 2);
    EXPECT_EQ(scene.shapes[1].params.line(), 2);
    EXPECT_EQ(scene.shapes[1].params.path(), (folder_ / "part.pbrt").string());
}

struct Refused {
    const char* text;
    const char* place;
    const char* expected; ///< part of it
    const char* found;    ///< part of it
};

TEST_F(PbrtParser, RefusesWithPlaceAndChoices) {
    const Refused cases[] = {
        {"WorldBegin\n  Shap \"x\"", "2:3", "Shape, Texture, Transform", "Shap"},
        {"Camera \"realistic\"\nWorldBegin", "1:8", "\"perspective\" or \"orthographic\"",
         "realistic"},
        {"Camera \"perspective\" \"float fov\" 180\nWorldBegin", "1:22", "between 0 and 180",
         "180"},
        {"Camera \"perspective\" \"float lensradius\" 1\nWorldBegin", "1:22", "fov", "lensradius"},
        {"Camera \"perspective\" \"float fov\" [40\nWorldBegin", "2:1", "number", "WorldBegin"},
        {"Camera \"perspective\" \"integer fov\" 40\nWorldBegin", "1:22", "float", "integer fov"},
        {"Film \"rgb\" \"integer xresolution\" 1.5\nWorldBegin", "1:34", "whole number", "1.5"},
        {"Film \"rgb\" \"integer xresolution\" 1e30\nWorldBegin", "1:34", "whole number", "1e30"},
        {"Film \"rgb\" \"integer xresolution\" 0\nWorldBegin", "1:12", "from 1", "0"},
        {"Film \"rgb\" \"blackbody L\" 3000\nWorldBegin", "1:12", "rgb, string", "blackbody L"},
        {"Film \"rgb\" \"float\" 3000\nWorldBegin", "1:12", "\"type name\"", "float"},
        {"Sampler \"halton\"\nWorldBegin", "1:9", "\"independent\" or \"sobol\"", "halton"},
        {"PixelFilter \"gaussian\"\nWorldBegin", "1:13", "box", "gaussian"},
        {"Integrator \"bdpt\"\nWorldBegin", "1:12", "path", "bdpt"},
        {"ColorSpace \"rec2020\"\nWorldBegin", "1:12", "srgb", "rec2020"},
        {"Scale 1 0 1\nWorldBegin", "1:1", "can be inverted", "singular"},
        {"Rotate 90 0 0 0\nWorldBegin", "1:1", "can be inverted", "singular"},
        {"Transform [1 0 0 0 0 1 0 0 0 0 1 0 0 0 0 2]\nWorldBegin", "1:1", "makes 0 0 0 1",
         "0 0 0 2"},
        {"ConcatTransform [1 0 0 0 0 1 0 .5 0 0 1 0 0 0 0 1]\nWorldBegin", "1:1", "makes 0 0 0 1",
         "0 0.5 0 1"},
        {"LookAt 0 0 0 0 0 1 0 0 1\nWorldBegin", "1:1", "apart", "LookAt"},
        {"Translate 1 2 inf\nWorldBegin", "1:15", "three numbers", "inf"},
        {"Translate 1 2 1e999\nWorldBegin", "1:15", "finite", "1e999"},
        {"Translate 1 2 3..4\nWorldBegin", "1:15", "number", "3..4"},
        {"CoordSysTransform \"camera\"\nWorldBegin", "1:19", "none yet", "camera"},
        {"Shape \"plymesh\"", "1:1", "WorldBegin before Shape", "none"},
        {"WorldBegin\nWorldBegin", "2:1", "before WorldBegin", "after"},
        {"WorldBegin\nAttributeEnd", "2:1", "AttributeBegin", "AttributeEnd"},
        {"WorldBegin\nAttributeBegin\nTransformEnd", "3:1", "AttributeEnd", "TransformEnd"},
        {"WorldBegin\nAttributeBegin", "2:15", "AttributeEnd", "end of the file"},
        {"Scale 1 1 1", "1:12", "WorldBegin", "end of the file"},
        {"WorldBegin\nNamedMaterial \"silk\"", "2:15", "none yet", "silk"},
        {"WorldBegin\nMakeNamedMaterial \"a\" \"string type\" \"diffuse\"\nNamedMaterial \"b\"",
         "3:15", "\"a\"", "b"},
        {"WorldBegin\nObjectInstance \"a\"", "2:16", "none yet", "a"},
        {"WorldBegin\nObjectBegin \"a\"\nObjectBegin \"b\"", "3:1", "ObjectEnd", "within"},
        {"WorldBegin\nObjectBegin \"a\"\nObjectInstance \"a\"", "3:1", "ObjectEnd", "within"},
        {"WorldBegin\nObjectBegin \"a\"", "2:16", "ObjectEnd", "end of the file"},
        {"WorldBegin\nAreaLightSource \"diffuse\"\nObjectBegin \"a\"\nShape \"disk\"", "4:1",
         "without area lights", "shines"},
        {"WorldBegin\nTexture \"a\" \"float\" \"imagemap\"", "2:13", "\"spectrum\"", "float"},
        {"WorldBegin\nTexture \"a\" \"spectrum\" \"checkerboard\"", "2:24", "\"imagemap\"",
         "checkerboard"},
        {"WorldBegin\nAreaLightSource \"spot\"", "2:17", "diffuse", "spot"},
        {"WorldBegin\nShape \"gltf\" \"string filename\" [\"a\" 1]", "2:37", "string", "1"},
        {"WorldBegin\nShape \"gltf\" \"float a\" 1 \"float a\" 2", "2:26", "once", "second"},
        {"WorldBegin\nShape \"gltf", "2:7", "closed", "end of the file"},
        {"WorldBegin\nShape \"gl\\qtf\"", "2:7", "escapes", "q"},
        {"WorldBegin\n\x01", "2:1", "directive", "0x01"},
        {"Film \"hdr\"\nWorldBegin", "1:6", "rgb", "hdr"},
        {"WorldBegin\nMakeNamedMaterial \"a\" \"rgb reflectance\" 1", "2:19", "string type",
         "none"},
        {"WorldBegin\nInclude  \"absent.pbrt\"", "2:10", "name of a file", "absent.pbrt"},
        {"WorldBegin\nInclude \"scene.pbrt\"", "2:1", "WorldBegin", "WorldBegin"},
    };
    for (const Refused& refused : cases) {
        SCOPED_TRACE(refused.text);
        try {
            parse(refused.text);
            ADD_FAILURE() << "was accepted";
        } catch (const FileError& error) {
            EXPECT_EQ(error.path, (folder_ / "scene.pbrt").string());
            if (std::string(refused.text).find("Include \"scene") == std::string::npos) {
                EXPECT_EQ(error.place, refused.place) << error.what();
                EXPECT_NE(error.expected.find(refused.expected), std::string::npos) << error.what();
                EXPECT_NE(error.found.find(refused.found), std::string::npos) << error.what();
            }
        }
    }
}

TEST_F(PbrtParser, RefusesEndlessIncludesAndMissingFiles) {
    write("loop.pbrt", "Include \"loop.pbrt\"");
    EXPECT_THROW(parse_world("Include \"loop.pbrt\""), FileError);
    EXPECT_THROW(parse_world("Include \"absent.pbrt\""), FileError);
    EXPECT_THROW(parse_pbrt(folder_ / "absent.pbrt"), FileError);
    EXPECT_THROW(parse_pbrt(folder_.path()), FileError);
}

} // namespace
} // namespace rapport
