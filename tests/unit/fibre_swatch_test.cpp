#include "renderer/core/error.h"
#include "renderer/integrator/path_tracer.h"
#include "renderer/scene/pbrt/pbrt_parser.h"
#include "renderer/scene/scene_builder.h"
#include "renderer/scene/shape/fibre_swatch.h"
#include "tests/support/file_bytes.h"
#include "tests/support/swatch.h"
#include "tests/support/temporary_folder.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

namespace rapport {
namespace {

std::shared_ptr<const FibreSwatch> swatch(double size_um) {
    return std::make_shared<const FibreSwatch>(tests::clear_cloth("viscose-plain"),
                                               glm::dvec2(size_um), "");
}

double mean_green(const Scene& scene) {
    const Image image = render(scene).image();
    double sum = 0;
    for (const float value : *image.find("G"))
        sum += value;
    return sum / (image.width * image.height);
}

TEST(FibreSwatch, DisappearsInAFurnace) {
    // Clear fibres under a sky of one radiance look like the sky, whichever way light takes, also
    // where a diffuse white plate behind them is seen through them and lit through them.
    const auto fibres = swatch(800);
    for (const float plate : {0.0f, 1.0f}) {
        std::vector<Surface> surfaces;
        surfaces.push_back(tests::fibre_surface(fibres));
        if (plate > 0)
            surfaces.push_back(
                tests::surface(tests::level_square(2e-4f, -4e-4f), tests::diffuse(plate)));
        const Scene scene(std::move(surfaces), {tests::sky(1)},
                          tests::parallel_camera({2e-3f, 1e-3f, 3e-3f}, {}, 3e-4f, 8),
                          tests::settings(64, 200));
        EXPECT_NEAR(mean_green(scene), 1, 1e-3) << plate;
    }
}

TEST(FibreSwatch, LetsLightSamplesThroughItsGapsAlone) {
    // A furnace whose walls are lamps, which are sampled: light that reaches the plate through gaps
    // between yarns is found by shadow rays too, and the rest by paths alone. Fibres that cast no
    // shadow would make the plate brighter than the walls, fibres without gaps darker.
    std::vector<Surface> surfaces;
    surfaces.push_back(tests::fibre_surface(swatch(3000)));
    surfaces.push_back(tests::surface(tests::level_square(1e-4f, -1e-4f), tests::diffuse(1)));
    TriangleMesh walls = tests::cube(0.02f);
    reverse_orientation(walls);
    surfaces.push_back(tests::surface(std::move(walls), tests::diffuse(0), 1));
    const Scene scene(std::move(surfaces), {}, tests::parallel_camera({0, 0, 1e-2f}, {}, 5e-5f, 8),
                      tests::settings(256, 400));
    EXPECT_NEAR(mean_green(scene), 1, 5e-3);
}

TEST(FibreSwatch, ShowsTheSkyThroughItsGapsAtEveryDepth) {
    // What passes between the fibres is not scattered, so that no limit on that ends it.
    const Scene scene = [] {
        std::vector<Surface> surfaces;
        surfaces.push_back(tests::fibre_surface(swatch(3000)));
        return Scene(std::move(surfaces), {tests::sky(1)},
                     tests::parallel_camera({0, 0, 1e-2f}, {}, 5e-4f, 32), tests::settings(64, 0));
    }();
    constexpr int kRays = 256;
    double passed = 0;
    for (int i = 0; i < kRays * kRays; ++i) {
        const glm::vec2 place = (glm::vec2(i % kRays, i / kRays) + 0.5f) / float{kRays};
        const kernel::Ray ray = scene.camera.ray(glm::vec2(scene.camera.resolution) * place);
        const auto point = scene.intersect(ray);
        passed += point && point->surface->fibres->pass(point->position, ray.dir);
    }
    passed /= kRays * kRays;
    EXPECT_GT(passed, 0.005);
    EXPECT_NEAR(mean_green(scene), passed, 5e-3);
}

TEST(FibreSwatch, LooksTheSameAtEverySizeAndPlace) {
    const auto fibres = swatch(800);
    const auto radiance = [&](const glm::mat4& to_world) {
        std::vector<Surface> surfaces;
        surfaces.push_back(tests::fibre_surface(fibres, to_world));
        TriangleMesh lamp = tests::level_square(1e-3f, 2e-3f);
        transform(lamp, to_world);
        reverse_orientation(lamp);
        surfaces.push_back(tests::surface(std::move(lamp), tests::diffuse(0), 1));
        Camera camera = tests::parallel_camera({5e-4f, 3e-4f, 1e-3f}, {}, 2e-4f, 8);
        const float scale = glm::length(glm::vec3(to_world[0]));
        camera.to_world = to_world * camera.to_world;
        for (int axis = 0; axis < 3; ++axis)
            camera.to_world[axis] /= scale;
        camera.screen_window *= scale;
        return mean_green(Scene(std::move(surfaces), {}, camera, tests::settings(1024, 200)));
    };
    const double here = radiance(glm::mat4(1));
    EXPECT_GT(here, 0.02);
    glm::mat4 far = glm::rotate(glm::mat4(1), 1.0f, glm::normalize(glm::vec3(1, 2, 3)));
    far = glm::scale(far, glm::vec3(1000));
    far[3] = {3, -2, 1, 1};
    EXPECT_NEAR(radiance(far), here, 0.05 * here); // four standard errors
}

TEST(FibreSwatch, EndsAtItsSides) {
    const auto fibres = swatch(300);
    CounterRng rng(3, Purpose::test, 0, 0);
    int sides = 0;
    for (int i = 0; i < 2000; ++i) {
        const glm::dvec3 from{300 * (rng.uniform() - 0.5), 300 * (rng.uniform() - 0.5),
                              fibres->high().z};
        const auto passage = fibres->follow(from, glm::normalize(glm::dvec3(0.5, 0.3, -0.4)), rng);
        ASSERT_TRUE(passage);
        for (int axis = 0; axis < 3; ++axis) {
            EXPECT_GE(passage->position[axis], fibres->low()[axis] - 1e-6);
            EXPECT_LE(passage->position[axis], fibres->high()[axis] + 1e-6);
        }
        EXPECT_GT(glm::dot(passage->direction, passage->normal), 0);
        EXPECT_NEAR(glm::length(passage->direction), 1, 1e-9);
        sides += passage->normal.z == 0;
    }
    EXPECT_GT(sides, 200);
}

void build(const std::string& lines) {
    const tests::TemporaryFolder folder;
    const auto path = folder / "scene.pbrt";
    tests::write_bytes(path, "Camera \"perspective\"\nWorldBegin\n" + lines);
    std::vector<std::string> warnings;
    build_scene(parse_pbrt(path), {}, warnings);
}

void expect_refused(const std::string& lines, const std::string& expected) {
    try {
        build(lines);
        ADD_FAILURE() << lines;
    } catch (const FileError& error) {
        EXPECT_NE(std::string(error.what()).find(expected), std::string::npos) << error.what();
    }
}

TEST(FibreSwatch, RefusesWhatCannotBeRendered) {
    const std::string fibers = fmt::format("Shape \"fibers\" \"string filename\" \"{}\" ",
                                           RAPPORT_SOURCE_DIR "/scenes/cloths/silk-charmeuse.toml");
    expect_refused("LightSource \"distant\"\n" + fibers, "lights of some size");
    expect_refused("Scale 1 1 2\n" + fibers, "transform of turns");
    expect_refused("AreaLightSource \"diffuse\"\n" + fibers, "do not shine");
    expect_refused(fibers + "\"float width\" -1", "metres above 0");
    expect_refused(fibers + "\"string colourway\" \"mauve\"", "colourway");
    expect_refused("Shape \"fibers\"", "string filename");
    const std::string away = "Translate 0.002 0 0.1\nRotate 30 0 0 1\n" + fibers;
    expect_refused(fibers, "one among them"); // the camera is at the origin
    const auto triangle = [](double z) {      // its corners far outside, its plane across
        return fmt::format("\nShape \"trianglemesh\" \"point3 P\" [-9 -9 {0}  9 -9 {0}  0 9 {0}] "
                           "\"integer indices\" [0 1 2]",
                           z);
    };
    expect_refused(away + triangle(0), "no other shape");
    expect_refused(away + "\nTranslate 0.009 0 0\n" + fibers, "no other shape");
    for (const std::string& beside : {triangle(2e-4), triangle(-2e-4)})
        build(away + beside);
    build(away + "\nTranslate 0.011 0 0\n" + fibers);
}

} // namespace
} // namespace rapport
