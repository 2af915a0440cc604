#include "materials/bsdf.h"

#include "materials/table/table_bsdf.h"
#include "renderer/core/error.h"
#include "tests/support/synthetic_tables.h"

#include <gtest/gtest.h>

namespace rapport {
namespace {

Params make_params(std::vector<Param> params) {
    Params all("scene.pbrt", "Material", 7);
    for (Param& param : params)
        all.add(std::move(param));
    return all;
}

std::shared_ptr<const TableBsdf> satin() {
    static const auto table = std::make_shared<const TableBsdf>(
        tests::small_synthetic_table(tests::satin_intensity, 0.05), "satin.bsdf");
    return table;
}

std::shared_ptr<const TableBsdf> black() {
    return std::make_shared<const TableBsdf>(
        tests::small_synthetic_table([](const auto&, const auto&, size_t) { return 0.0; }),
        "satin.bsdf");
}

std::shared_ptr<const Bsdf> make(const std::string& name, const std::vector<Param>& list) {
    const Params params = make_params(list);
    const auto load = [](const std::filesystem::path& path, const std::string& colourway) {
        EXPECT_EQ(path, std::filesystem::path("cloths") / "satin.bsdf");
        return colourway.empty() ? satin() : black();
    };
    return make_material(name, {params, "cloths", load});
}

FileError error_of(const std::string& name, const std::vector<Param>& list) {
    try {
        make(name, list);
    } catch (const FileError& error) {
        return error;
    }
    return {"", "", "an error", "none"};
}

Param text(const std::string& name, const std::string& value) {
    return {.type = "string", .name = name, .numbers = {}, .strings = {value}};
}
Param number(const std::string& name, double value) {
    return {.type = "float", .name = name, .numbers = {value}, .strings = {}};
}
Param rgb(const std::string& name, double r, double g, double b) {
    return {.type = "rgb", .name = name, .numbers = {r, g, b}, .strings = {}};
}

glm::vec3 direction(double theta_degrees, double phi_degrees) {
    return glm::vec3(spherical_direction(radians(theta_degrees), radians(phi_degrees)));
}

TEST(Materials, AreAllRegistered) {
    EXPECT_EQ(
        MaterialRegistry::instance().names(),
        (std::vector<std::string>{"cloth", "conductor", "dielectric", "diffuse", "measured"}));
}

TEST(Materials, UnknownNameListsTheKnown) {
    const FileError error = error_of("satin", {});
    EXPECT_EQ(error.path, "scene.pbrt");
    EXPECT_EQ(error.place, "7");
    EXPECT_NE(error.expected.find("cloth, conductor, dielectric, diffuse, measured"),
              std::string::npos);
    EXPECT_NE(error.found.find("satin"), std::string::npos);
}

TEST(Materials, UnknownParametersAreErrors) {
    EXPECT_NE(error_of("diffuse", {number("roughness", 0.1)}).found, "none");
    EXPECT_NE(error_of("cloth", {text("filename", "satin.bsdf"), text("color", "red")}).found,
              "none");
}

TEST(Diffuse, IsLambertsLawOnBothSides) {
    const auto material = make("diffuse", {rgb("reflectance", 0.8, 0.4, 0)});
    const glm::vec3 eye = direction(40, 10), light = direction(60, 200);
    EXPECT_NEAR(material->eval(eye, light).r, 0.8 * 0.5 / kPi, 1e-6);
    EXPECT_NEAR(material->eval(-eye, -light).g, 0.4 * 0.5 / kPi, 1e-6);
    EXPECT_EQ(material->eval(eye, -light), Rgb(0));
    EXPECT_EQ(material->pdf(-eye, light), 0);
    EXPECT_EQ(material->albedo(eye), Rgb(0.8f, 0.4f, 0));
    EXPECT_EQ(material->unscattered(eye), Rgb(0));
    EXPECT_EQ(make("diffuse", {})->albedo(eye), Rgb(0.5f));
}

TEST(Diffuse, BlackScattersNothing) {
    const auto material = make("diffuse", {rgb("reflectance", 0, 0, 0)});
    const glm::vec3 up(0, 0, 1);
    EXPECT_FALSE(material->sample(up, 0.5f, {0.5f, 0.5f}));
    EXPECT_EQ(material->pdf(up, up), 0);
}

TEST(Diffuse, RefusesImpossibleReflectance) {
    EXPECT_EQ(error_of("diffuse", {rgb("reflectance", 1.2, 0, 0)}).found, "1.2");
    EXPECT_NE(error_of("diffuse", {rgb("reflectance", -0.1, 0, 0)}).found, "none");
}

TEST(Cloth, IsItsTable) {
    const auto material = make("cloth", {text("filename", "satin.bsdf")});
    const glm::vec3 eye = direction(40, 10), light = direction(60, 200);
    EXPECT_EQ(material->eval(eye, light), satin()->eval(eye, light));
    EXPECT_EQ(material->pdf(eye, -light), satin()->pdf(eye, -light));
    EXPECT_EQ(material->albedo(-eye), satin()->albedo(-eye));
    EXPECT_EQ(material->unscattered(eye), satin()->unscattered(eye));
    EXPECT_GT(material->unscattered(eye).r, 0);
}

TEST(Cloth, TurnsCounterClockwiseSeenFromTheFace) {
    // What the cloth does towards φ, the turned cloth does towards φ + rotation.
    const auto turned = make("cloth", {text("filename", "satin.bsdf"), number("rotation", 30)});
    const glm::vec3 eye = direction(40, 10), light = direction(60, 200);
    const glm::vec3 turned_eye = direction(40, 40), turned_light = direction(60, 230);
    EXPECT_NEAR(turned->eval(turned_eye, turned_light).r, satin()->eval(eye, light).r, 1e-5);
    EXPECT_NEAR(turned->pdf(turned_eye, turned_light), satin()->pdf(eye, light), 1e-5);
    EXPECT_GT(std::abs(turned->eval(eye, light).r - satin()->eval(eye, light).r), 1e-3);
    const auto a = turned->sample(turned_eye, 0.3f, {0.2f, 0.6f});
    const auto b = satin()->sample(eye, 0.3f, {0.2f, 0.6f});
    ASSERT_TRUE(a && b);
    EXPECT_NEAR(a->pdf, b->pdf, 1e-4);
    EXPECT_NEAR(std::remainder(azimuth(a->light) - azimuth(b->light) - radians(30.0), 2 * kPi), 0,
                1e-4);
}

/// A streak that no mirror leaves as it is, on one side of the cloth more than on the other.
double slanting(const IncidentDirection& from, const glm::dvec3& out, size_t) {
    const glm::dvec3 sum = spherical_direction(from.theta, from.phi) + out;
    return (out.z > 0 ? 0.1 : 0.05) * std::exp(-square(sum.x + 0.6 * sum.y));
}

TEST(Cloth, MirroredIsTheWeaveInAMirrorThenTurned) {
    const auto table = std::make_shared<const TableBsdf>(
        tests::small_synthetic_table(slanting, 0.05), "satin.bsdf");
    const auto make_slanting = [&](const std::vector<Param>& list) {
        return make_material(
            "cloth", {make_params(list), "", [&](const auto&, const auto&) { return table; }});
    };
    const Param file = text("filename", "satin.bsdf");
    const Param mirrored{.type = "bool", .name = "mirrored", .numbers = {1}, .strings = {}};
    const auto plain = make_slanting({file}), mirror = make_slanting({file, mirrored});
    const auto turned = make_slanting({file, mirrored, number("rotation", 30)});
    const auto across_warp = [](const glm::vec3& w) { return glm::vec3(-w.x, w.y, w.z); };
    for (const float side : {1.0f, -1.0f}) {
        const glm::vec3 eye = side * direction(40, 10), light = direction(60, 200);
        const glm::vec3 eye_there = across_warp(eye), light_there = across_warp(light);
        EXPECT_NEAR(mirror->eval(eye, light).r, plain->eval(eye_there, light_there).r, 1e-6);
        EXPECT_NEAR(mirror->pdf(eye, light), plain->pdf(eye_there, light_there), 1e-6);
        EXPECT_NEAR(mirror->albedo(eye).r, plain->albedo(eye_there).r, 1e-6);
        EXPECT_EQ(mirror->unscattered(eye), plain->unscattered(eye_there));
        EXPECT_GT(std::abs(mirror->eval(eye, light).r / plain->eval(eye, light).r - 1), 0.05);

        const auto a = mirror->sample(eye, 0.3f, {0.2f, 0.6f});
        const auto b = plain->sample(eye_there, 0.3f, {0.2f, 0.6f});
        ASSERT_TRUE(a && b);
        EXPECT_LT(glm::distance(a->light, across_warp(b->light)), 1e-5);
        EXPECT_NEAR(a->pdf, mirror->pdf(eye, a->light), 1e-3 * a->pdf);

        const auto by_30 = [](const glm::vec3& w) {
            const float c = std::cos(radians(30.0f)), s = std::sin(radians(30.0f));
            return glm::vec3(c * w.x - s * w.y, c * w.y + s * w.x, w.z);
        };
        EXPECT_NEAR(turned->eval(by_30(eye), by_30(light)).r, mirror->eval(eye, light).r, 1e-5);
        const auto c = turned->sample(by_30(eye), 0.3f, {0.2f, 0.6f});
        ASSERT_TRUE(c);
        EXPECT_LT(glm::distance(c->light, by_30(a->light)), 1e-4);
    }
}

TEST(Cloth, ComesInColourways) {
    const auto own = make("cloth", {text("filename", "satin.bsdf")});
    const auto dyed = make("cloth", {text("filename", "satin.bsdf"), text("colourway", "black")});
    EXPECT_GT(own->albedo({0, 0, 1}).r, 0);
    EXPECT_EQ(dyed->albedo({0, 0, 1}), Rgb(0));
}

TEST(Cloth, NeedsAFileName) {
    EXPECT_NE(error_of("cloth", {}).expected.find("filename"), std::string::npos);
}

} // namespace
} // namespace rapport
