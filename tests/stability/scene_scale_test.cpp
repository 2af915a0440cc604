#include "renderer/integrator/path_tracer.h"
#include "renderer/scene/scene.h"
#include "tests/support/pictures.h"

#include <glm/gtc/matrix_transform.hpp>

// The renderer far from the origin of coordinates, and at sizes from a tenth of a millimetre to ten
// kilometres: rays must neither meet the surface that they leave, nor pass through the next one.

namespace rapport {
namespace {

struct Place {
    float size;       ///< of the body [m]
    glm::vec3 centre; ///< [m]
};
const std::vector<Place> kPlaces{
    {1, {0, 0, 0}},    {1e-4f, {0, 0, 0}},  {1e4f, {0, 0, 0}},           {1, {1e2f, -1e2f, 1e2f}},
    {1, {1e5f, 0, 0}}, {1e-4f, {1, -2, 3}}, {1e3f, {1e5f, -1e5f, 1e5f}}, {1, {-1e5f, 1e5f, 1e5f}}};

std::string name_of(const Place& place) {
    return "size " + std::to_string(place.size) + " at " + std::to_string(place.centre.x) + ", " +
           std::to_string(place.centre.y) + ", " + std::to_string(place.centre.z);
}

/// A ball of 2 · 48 · 24 triangles with smooth normals.
TriangleMesh ball(const Place& place) {
    TriangleMesh mesh;
    constexpr uint32_t kColumns = 48, kRows = 24;
    for (uint32_t j = 0; j <= kRows; ++j)
        for (uint32_t i = 0; i < kColumns; ++i) {
            const glm::dvec3 n =
                spherical_direction(kPi * (0.01 + 0.98 * j / kRows), 2 * kPi * i / kColumns);
            mesh.positions.push_back(glm::dvec3(place.centre) + double{place.size} * n);
            mesh.normals.push_back(n);
        }
    for (uint32_t j = 0; j < kRows; ++j)
        for (uint32_t i = 0; i < kColumns; ++i) {
            const uint32_t a = j * kColumns + i, b = j * kColumns + (i + 1) % kColumns;
            mesh.triangles.emplace_back(a, a + kColumns, b + kColumns);
            mesh.triangles.emplace_back(a, b + kColumns, b);
        }
    for (const uint32_t row : {0u, kRows}) // the caps
        for (uint32_t i = 1; i + 1 < kColumns; ++i) {
            const uint32_t a = row * kColumns, b = a + i, c = b + 1;
            mesh.triangles.push_back(row == 0 ? glm::uvec3(a, b, c) : glm::uvec3(a, c, b));
        }
    return mesh;
}

/// Under equal radiance from everywhere a white body cannot be seen. Where floats cannot hold its
/// shape (their step at 10⁵ m is 8 mm) its facets shade each other, but lose nothing to it.
TEST(SceneScale, AWhiteBodyVanishesEverywhere) {
    for (const Place& place : kPlaces) {
        SCOPED_TRACE(name_of(place));
        const Camera camera =
            tests::parallel_camera(place.centre + 3 * place.size * glm::vec3(0.6f, 0.64f, 0.48f),
                                   place.centre, 1.2f * place.size, 24);
        const tests::Picture picture(Scene({tests::surface(ball(place), tests::diffuse(1))},
                                           {tests::sky(1)}, camera, tests::settings(64, 200)));
        EXPECT_NEAR(picture.mean(), 1, 4 * picture.error() + 2e-4);
    }
}

/// Close before a lamp stands a shade, nearer by 1/20000 of the lamp's distance from the ground.
TEST(SceneScale, AShadeCoversTheLampCloseBehindIt) {
    for (const float size : {1e-3f, 1.0f, 1e4f}) {
        SCOPED_TRACE(size);
        const auto looking_down = [&](const TriangleMesh& square) {
            TriangleMesh turned = square;
            reverse_orientation(turned);
            return turned;
        };
        const Surface ground = tests::surface(tests::level_square(size, 0), tests::diffuse(0.5f));
        const Surface lamp =
            tests::surface(looking_down(tests::level_square(size / 4, size)), tests::diffuse(0), 1);
        const Surface shade =
            tests::surface(tests::level_square(size, size * (1 - 5e-5f)), tests::diffuse(0));
        const Camera camera = tests::parallel_camera({0, 0, size / 2}, {0, 0, 0}, size / 2, 16);
        const auto lit = [&](const std::vector<Surface>& surfaces) {
            return tests::Picture(Scene(surfaces, {}, camera, tests::settings(16, 2))).mean();
        };
        EXPECT_GT(lit({ground, lamp}), 0.01);
        EXPECT_EQ(lit({ground, lamp, shade}), 0);
    }
}

/// Inside a closed body no light arrives from outside, and all of what shines inside stays there: a
/// wall of reflectance ½ that shines with radiance 1 is seen under 1/(1 − ½) = 2.
TEST(SceneScale, ClosedBodiesAreTight) {
    for (const Place& place : kPlaces) {
        SCOPED_TRACE(name_of(place));
        Camera camera =
            tests::parallel_camera(place.centre, place.centre + glm::vec3(0.3f, 0.2f, 1), 1, 24);
        camera.kind = Camera::Kind::perspective;
        camera.fov_degrees = 120;
        TriangleMesh wall = ball(place);
        reverse_orientation(wall); // faces inwards
        const tests::Picture dark(Scene({tests::surface(wall, tests::diffuse(0.5f))},
                                        {tests::sky(1e6f), tests::sun(1e6f, {0.1f, 0.2f, 1})},
                                        camera, tests::settings(64, 100)));
        EXPECT_EQ(dark.largest(), 0);
        const tests::Picture bright(Scene({tests::surface(wall, tests::diffuse(0.5f), 1)}, {},
                                          camera, tests::settings(64, 100)));
        // Where the corners of facets are rounded to floats, these are tilted by up to a step of
        // floats over their size; what goes that close to the horizon may be lost.
        const glm::vec3 far = glm::abs(place.centre) + place.size;
        const double step = 0x1p-23 * std::max({far.x, far.y, far.z});
        const double facet = kPi / 24 * place.size;
        EXPECT_NEAR(bright.mean(), 2, 4 * bright.error() + 2e-3 + 2 * step / facet);
    }
}

/// A lamp behind 20 layers of open cloth, as folds lie on each other, is dimmed by each in turn:
/// seen directly, and as it lights a floor.
TEST(FoldedCloth, TwentyLayersLetTheirShareThrough) {
    const auto open = tests::cloth([](const auto&, const auto&, size_t) { return 0.0; }, 0.9);
    const double through = std::pow(0.9, 20);
    for (const float gap : {1e-2f, 1e-4f}) {
        SCOPED_TRACE(gap);
        std::vector<Surface> surfaces;
        for (int layer = 1; layer <= 20; ++layer)
            surfaces.push_back(
                tests::surface(tests::level_square(2, 1 + gap * static_cast<float>(layer)), open));
        surfaces.push_back(tests::surface(tests::level_square(50, 0), tests::diffuse(1)));
        // From below the layers, past which the camera sees a radiant ceiling.
        std::vector<Surface> ceiling = surfaces;
        ceiling.pop_back();
        ceiling.push_back(tests::surface(
            tests::parallelogram({-50, 50, 3}, {100, 0, 0}, {0, -100, 0}), tests::diffuse(0), 5));
        const tests::Picture seen(Scene(ceiling, {},
                                        tests::parallel_camera({0, 0, 0.5f}, {0, 0, 1}, 0.1f, 32),
                                        tests::settings(256, 5)));
        // Nothing scatters, so every path is the same product: in single precision, each layer's
        // factor and multiplication round by 2⁻²⁴ at most.
        EXPECT_NEAR(seen.mean(), 5 * through, 4 * seen.error() + 2 * 20 * 0x1p-24 * 5 * through);
        const tests::Picture lit(Scene(surfaces, {tests::sun(2, {0, 0, 1})},
                                       tests::parallel_camera({0, 0, 0.5f}, {0, 0, 0}, 0.1f, 16),
                                       tests::settings(16, 1)));
        EXPECT_NEAR(lit.mean(), 2 * through / kPi, 1e-4);
    }
    // Between folds: a lamp between layers of cloth that absorbs nothing lights them without end.
    const auto white = tests::cloth([](const IncidentDirection&, const glm::dvec3& out,
                                       size_t) { return 0.6 * std::abs(out.z) / (2 * kPi); },
                                    0.4);
    std::vector<Surface> folds;
    for (int layer = -10; layer < 10; ++layer)
        folds.push_back(tests::surface(
            tests::level_square(1, 1e-3f * (static_cast<float>(layer) + 0.5f)), white));
    folds.push_back(tests::surface(tests::level_square(0.1f, 1e-4f), tests::diffuse(0), 10));
    const tests::Picture inside(Scene(
        folds, {}, tests::parallel_camera({0, 0, 3}, {0, 0, 0}, 1, 32), tests::settings(64, 500)));
    EXPECT_GT(inside.mean(), 0);
    EXPECT_LT(inside.largest(), 10); // nowhere brighter than the lamp
}

} // namespace
} // namespace rapport
