#include "renderer/integrator/streaks.h"

#include "renderer/integrator/path_tracer.h"
#include "tests/support/small_scenes.h"

#include <gtest/gtest.h>

namespace rapport {
namespace {

/// A square seen square on, its warp turned by `angle` on the film.
Image streaks(double angle, bool back) {
    TriangleMesh mesh = tests::level_square(1, 0);
    const auto c = static_cast<float>(std::cos(angle)), s = static_cast<float>(std::sin(angle));
    for (size_t i = 0; i < 4; ++i) {
        const glm::vec3 p = mesh.positions[i];
        mesh.uvs[i] = {c * p.x + s * p.y, c * p.y - s * p.x};
    }
    Camera camera = tests::parallel_camera({0, 0, back ? -3 : 3}, {0, 0, 0}, 1, 64);
    camera.to_world = glm::mat4(1);
    camera.to_world[2].z = back ? 1 : -1;
    camera.to_world[3] = {0, 0, back ? -3 : 3, 1};
    const Scene scene({tests::surface(mesh, tests::diffuse(0.5f))}, {tests::sky(1)}, camera,
                      tests::settings(4, 1));
    return warp_streaks(render(scene).image(), camera);
}

/// Mean square step of the picture's green between pixels apart by (dx, dy).
double roughness(const Image& image, int dx, int dy) {
    double sum = 0;
    int count = 0;
    const auto& green = *image.find("G");
    for (int y = 2; y < image.height - 2; ++y)
        for (int x = 2; x < image.width - 2; ++x, ++count)
            sum += square(green[static_cast<size_t>(y * image.width + x)] -
                          green[static_cast<size_t>((y + dy) * image.width + x + dx)]);
    return sum / count;
}

TEST(WarpStreaks, RunAlongTheWarp) {
    const Image upright = streaks(0, false), lying = streaks(kPi / 2, false);
    EXPECT_LT(5 * roughness(upright, 0, 1), roughness(upright, 1, 0));
    EXPECT_LT(5 * roughness(lying, 1, 0), roughness(lying, 0, 1));
    // Turned by 45° counter-clockwise from upright: up and to the left on the film.
    const Image slanted = streaks(kPi / 4, false);
    EXPECT_LT(3 * roughness(slanted, 1, 1), roughness(slanted, 1, -1));
}

TEST(WarpStreaks, TellTheSidesApart) {
    const auto blueness = [](const Image& image) {
        double red = 0, blue = 0;
        for (const float r : *image.find("R"))
            red += r;
        for (const float b : *image.find("B"))
            blue += b;
        return blue / red;
    };
    EXPECT_NEAR(blueness(streaks(0, false)), 1, 1e-6);
    EXPECT_GT(blueness(streaks(0, true)), 1.5);
}

} // namespace
} // namespace rapport
