#include "renderer/core/params.h"

#include "renderer/core/error.h"

#include <gtest/gtest.h>
#include <limits>

using namespace rapport;

namespace {

Params example() {
    Params params("scene.pbrt", "Shape \"gltf\"", 7);
    params.add({"float", "fov", {45}, {}, 7, 3});
    params.add({"integer", "spp", {64}, {}, 8, 3});
    params.add({"bool", "mirror", {1}, {}, 9, 3});
    params.add({"string", "filename", {}, {"dress.glb"}, 10, 3});
    params.add({"rgb", "reflectance", {0.1, 0.2, 0.3}, {}, 11, 3});
    params.add({"float", "grey", {0.5}, {}, 12, 3});
    params.add({"point3", "P", {0, 1, 2, 3, 4, 5}, {}, 13, 3});
    params.add({"normal", "N", {0, 0, 1}, {}, 14, 3});
    params.add({"point2", "uv", {0, 1, 2, 3}, {}, 15, 3});
    params.add({"integer", "indices", {0, 1, 2}, {}, 16, 3});
    return params;
}

template <class Body> FileError error_of(Body body) {
    try {
        body();
    } catch (const FileError& error) {
        return error;
    }
    ADD_FAILURE() << "no FileError";
    return FileError("", "", "", "");
}

} // namespace

TEST(Params, GivesWhatIsThere) {
    const Params params = example();
    EXPECT_EQ(params.get_float("fov", 0), 45);
    EXPECT_EQ(params.get_int("spp", 0), 64);
    EXPECT_TRUE(params.get_bool("mirror", false));
    EXPECT_EQ(params.get_string("filename", ""), "dress.glb");
    EXPECT_EQ(params.get_rgb("reflectance", Rgb(0)), Rgb(0.1f, 0.2f, 0.3f));
    EXPECT_EQ(params.get_rgb("grey", Rgb(0)), Rgb(0.5f));
    EXPECT_EQ(params.get_point("N", glm::vec3(9)), glm::vec3(0, 0, 1));
    EXPECT_EQ(params.get_point3s("P"), (std::vector<glm::vec3>{{0, 1, 2}, {3, 4, 5}}));
    EXPECT_EQ(params.get_point2s("uv"), (std::vector<glm::vec2>{{0, 1}, {2, 3}}));
    EXPECT_EQ(params.get_ints("indices"), (std::vector<int>{0, 1, 2}));
    EXPECT_EQ(params.get_floats("fov"), std::vector<float>{45});
    EXPECT_NO_THROW(params.check_all_used());
}

TEST(Params, FallsBackOnWhatIsNot) {
    const Params params("scene.pbrt", "Film \"rgb\"", 1);
    EXPECT_EQ(params.get_float("a", 1.5f), 1.5f);
    EXPECT_EQ(params.get_int("b", 3), 3);
    EXPECT_EQ(params.get_string("c", "x"), "x");
    EXPECT_EQ(params.get_rgb("d", Rgb(2)), Rgb(2));
    EXPECT_EQ(params.get_point("e", glm::vec3(4)), glm::vec3(4));
    EXPECT_TRUE(params.get_floats("f").empty());
    EXPECT_TRUE(params.get_point3s("g").empty());
    EXPECT_FALSE(params.has("h"));
    EXPECT_NO_THROW(params.check_all_used());
}

TEST(Params, RefusesWhatNobodyAskedForAndListsTheRest) {
    Params params("scene.pbrt", "Camera \"perspective\"", 4);
    params.add({"float", "fov", {45}, {}, 4, 10});
    params.add({"float", "fow", {45}, {}, 5, 12});
    params.get_float("fov", 90);
    params.get_float("lensradius", 0);
    const FileError error = error_of([&] { params.check_all_used(); });
    EXPECT_EQ(std::string(error.what()),
              "scene.pbrt:5:12: expected a parameter of Camera \"perspective\" (fov, lensradius), "
              "found \"float fow\"");
}

TEST(Params, RefusesWrongTypesCountsAndValues) {
    const Params params = example();
    EXPECT_EQ(error_of([&] { params.get_float("spp", 0); }).place, "8:3");
    EXPECT_EQ(error_of([&] { params.get_int("fov", 0); }).found, "\"float fov\"");
    EXPECT_EQ(error_of([&] { params.get_int("indices", 0); }).found, "3 values");
    EXPECT_EQ(error_of([&] { params.get_point("P", glm::vec3(0)); }).found, "6 values");
    EXPECT_EQ(error_of([&] { params.get_string("fov", ""); }).place, "7:3");
    EXPECT_EQ(error_of([&] { params.get_rgb("filename", Rgb(0)); }).place, "10:3");

    Params wrong("scene.pbrt", "Shape", 1);
    wrong.add({"integer", "half", {0.5}, {}, 2, 1});
    wrong.add({"integer", "huge", {3e9}, {}, 3, 1});
    wrong.add({"float", "nan", {std::numeric_limits<double>::quiet_NaN()}, {}, 4, 1});
    wrong.add({"float", "inf", {1e300}, {}, 5, 1});
    wrong.add({"point3", "P", {1, 2, 3, 4}, {}, 6, 1});
    wrong.add({"point2", "uv", {1, 2, 3}, {}, 7, 1});
    wrong.add({"rgb", "pair", {1, 2}, {}, 8, 1});
    wrong.add({"float", "greys", {1, 2}, {}, 9, 1});
    wrong.add({"float", "none", {}, {}, 10, 1});
    wrong.add({"integer", "nothing", {}, {}, 11, 1});
    EXPECT_EQ(error_of([&] { wrong.get_int("half", 0); }).place, "2:1");
    EXPECT_EQ(error_of([&] { wrong.get_int("huge", 0); }).place, "3:1");
    EXPECT_EQ(error_of([&] { wrong.get_float("nan", 0); }).place, "4:1");
    EXPECT_EQ(error_of([&] { wrong.get_floats("inf"); }).place, "5:1");
    EXPECT_EQ(error_of([&] { wrong.get_point3s("P"); }).place, "6:1");
    EXPECT_EQ(error_of([&] { wrong.get_point2s("uv"); }).place, "7:1");
    EXPECT_EQ(error_of([&] { wrong.get_rgb("pair", Rgb(0)); }).place, "8:1");
    EXPECT_EQ(error_of([&] { wrong.get_rgb("greys", Rgb(0)); }).found, "2 values");
    EXPECT_EQ(error_of([&] { wrong.get_rgb("nan", Rgb(0)); }).place, "4:1");
    EXPECT_EQ(error_of([&] { wrong.get_float("none", 0); }).found, "0 values");
    EXPECT_EQ(error_of([&] { wrong.get_int("nothing", 0); }).found, "0 values");
}

TEST(Params, RefusesASecondOfTheSameName) {
    Params params = example();
    const FileError error = error_of([&] { params.add({"float", "fov", {3}, {}, 20, 5}); });
    EXPECT_EQ(error.place, "20:5");
    EXPECT_NE(error.found.find("7:3"), std::string::npos);
}

TEST(Params, FailStandsAtTheParameterOrTheDirective) {
    const Params params = example();
    EXPECT_EQ(error_of([&] { params.fail("spp", "more", "less"); }).place, "8:3");
    EXPECT_EQ(error_of([&] { params.fail("absent", "a value", "none"); }).place, "7");
}
