#include "renderer/core/image.h"
#include "renderer/core/octahedral.h"
#include "renderer/integrator/path_tracer.h"
#include "renderer/scene/mesh/subdivision.h"
#include "renderer/scene/mesh/surface_frames.h"
#include "tests/support/control_meshes.h"
#include "tests/support/pictures.h"
#include "tests/support/temporary_folder.h"

// Geometry and light where methods fail: needles, grazing suns, crowded vertices, UVs without area,
// garments turned inside out, and a sky with one hot pixel.

namespace rapport {
namespace {

using tests::Picture;

/// A level sheet over [−1, 1]² whose middle is crossed by rows of triangles 10⁻⁶ thin.
TriangleMesh sheet_with_needles() {
    std::vector<float> rows{-1, -0.5f};
    for (int i = 0; i < 20; ++i)
        rows.push_back(1e-6f * static_cast<float>(i));
    rows.push_back(1);
    TriangleMesh mesh;
    for (const float y : rows)
        for (const float x : {-1.0f, 0.1f, 1.0f}) {
            mesh.positions.emplace_back(x, y, 0);
            mesh.uvs.emplace_back(x, y);
        }
    for (uint32_t j = 0; j + 1 < rows.size(); ++j)
        for (uint32_t i = 0; i < 2; ++i) {
            const uint32_t a = 3 * j + i;
            mesh.triangles.emplace_back(a, a + 1, a + 4);
            mesh.triangles.emplace_back(a, a + 4, a + 3);
        }
    return mesh;
}

TEST(Needles, AreLitLikeTheSheetTheyLieIn) {
    const TriangleMesh mesh = sheet_with_needles();
    // The film spans the needles alone, then the whole sheet.
    for (const float half : {1e-5f, 0.9f}) {
        const Picture picture(
            Scene({tests::surface(mesh, tests::diffuse(1))}, {tests::sun(1, {1, 2, 2})},
                  tests::parallel_camera({0, 0, 2}, {0, 0, 0}, half, 32), tests::settings(16, 2)));
        EXPECT_NEAR(picture.least(), 2 / 3.0 / kPi, 1e-4);
        EXPECT_NEAR(picture.largest(), 2 / 3.0 / kPi, 1e-4);
        EXPECT_NEAR(picture.mean("warp.Y"), 1, 1e-4);
    }
    IndexedMesh control;
    control.positions = mesh.positions;
    control.uvs = mesh.uvs;
    control.position_index = control.uv_index = mesh.triangles;
    const TriangleMesh limit = subdivide(control, tests::options(4, true), "needles");
    tests::expect_sound(limit);
    for (size_t v = 0; v < limit.positions.size(); ++v) {
        EXPECT_EQ(limit.positions[v].z, 0);
        EXPECT_LT(std::abs(limit.positions[v].x), 1 + 1e-5f);
        EXPECT_NEAR(std::abs(limit.normals[v].z), 1, 1e-5f);
    }
}

/// Irradiance falls with the sine of the elevation down to a millionth of a degree; below, no
/// light.
TEST(GrazingSun, LightsByTheSineOfItsElevation) {
    for (const double elevation : {10.0, 1.0, 1e-2, 1e-4, 1e-6, -1e-6, -1.0}) {
        SCOPED_TRACE(elevation);
        const glm::vec3 sun(std::cos(radians(elevation)), 0, std::sin(radians(elevation)));
        const Picture picture(Scene(
            {tests::surface(tests::level_square(1, 0), tests::diffuse(1))}, {tests::sun(1, sun)},
            tests::parallel_camera({0, 0, 2}, {0, 0, 0}, 0.9f, 16), tests::settings(16, 1)));
        const double expected = std::max(0.0, std::sin(radians(elevation))) / kPi;
        EXPECT_NEAR(picture.mean(), expected, 1e-4 * expected);
        EXPECT_NEAR(picture.largest(), expected, 1e-4 * expected);
    }
}

/// A ball of coarse facets with smooth normals, lit from the side, sends as much light to the
/// camera as a true one, (2/3) R²/π times the irradiance; facets that see the sun edge-on are a few
/// in a hundred, and hardly lit.
TEST(GrazingSun, LightsACoarseBallUpToItsTerminator) {
    TriangleMesh ball = subdivide(tests::icosahedron(), tests::options(8, false), "ball");
    for (size_t v = 0; v < ball.positions.size(); ++v)
        ball.positions[v] = ball.normals[v] = glm::normalize(ball.positions[v]);
    for (const glm::vec3& sun : {glm::vec3(1, 0, 0), glm::vec3(0, 1, 0), glm::vec3(-3, 4, 0)}) {
        const Picture picture(Scene({tests::surface(ball, tests::diffuse(1))}, {tests::sun(1, sun)},
                                    tests::parallel_camera({0, 0, 9}, {0, 0, 0}, 1.1f, 64),
                                    tests::settings(16, 1)));
        const double expected = 2 / (3 * kPi) / square(2.2);
        EXPECT_NEAR(picture.mean(), expected, 0.01 * expected + 4 * picture.error());
        EXPECT_LT(picture.largest(), 1.001 / kPi);
    }
}

TEST(Valence, FramesAndLightAreSoundFromThreeToFifty) {
    for (uint32_t valence = 3; valence <= 50; ++valence) {
        SCOPED_TRACE(valence);
        IndexedMesh mesh = tests::spindle(valence);
        tests::add_uvs(mesh, [](const glm::vec3& p) { return glm::vec2(p); });
        for (const bool quads : {false, true}) {
            SubdivisionOptions options = tests::options(4, true);
            options.quads = quads;
            const TriangleMesh limit = subdivide(mesh, options, "spindle");
            tests::expect_closed_manifold(limit);
            tests::expect_sound(limit);
            if (quads || valence % 8 != 3)
                continue;
            const Picture picture(Scene({tests::surface(limit, tests::diffuse(1))}, {tests::sky(1)},
                                        tests::parallel_camera({1, 1, 3}, {0, 0, 0}, 0.8f, 16),
                                        tests::settings(16, 50)));
            EXPECT_NEAR(picture.mean(), 1, 4 * picture.error() + 2e-3);
        }
    }
}

/// UVs that are squeezed towards a line: the frame stays until floats cannot tell the UVs apart,
/// and is mended then.
TEST(SingularUvs, LeaveASoundFrame) {
    for (int power = 0; power <= 20; ++power) {
        SCOPED_TRACE(power);
        const float squeeze = std::pow(10.0f, static_cast<float>(-power));
        IndexedMesh mesh = tests::sheet(6, [](float x, float y) { return 0.2f * x * y; });
        tests::add_uvs(mesh, [&](const glm::vec3& p) { return glm::vec2(p.x, squeeze * p.y); });
        SubdivisionReport report;
        const TriangleMesh limit = subdivide(mesh, tests::options(3, false), "sheet", &report);
        tests::expect_sound(limit);
        if (report.frames_repaired == 0) {
            EXPECT_LE(power, 8);
            for (const glm::vec3& warp : limit.warp)
                EXPECT_GT(glm::normalize(warp).y, 0.97f); // the sheet slopes by up to 0.2
        }
        // Sheared until u and v run along each other.
        tests::add_uvs(mesh,
                       [&](const glm::vec3& p) { return glm::vec2(p.x, p.x + squeeze * p.y); });
        tests::expect_sound(subdivide(mesh, tests::options(3, false), "sheet"));
        tests::expect_sound(flat_mesh(mesh));
    }
}

/// Inside out, the other side of the cloth shows; what is alike on both sides looks the same.
TEST(InsideOut, ShowsTheOtherSide) {
    TriangleMesh garment = subdivide(tests::icosahedron(), tests::options(4, false), "garment");
    TriangleMesh turned = garment;
    reverse_orientation(turned);
    const auto picture = [](const TriangleMesh& mesh, const std::shared_ptr<const Bsdf>& material) {
        return Picture(Scene({tests::surface(mesh, material)}, {tests::sky(1)},
                             tests::parallel_camera({2, 3, 9}, {0, 0, 0}, 0.8f, 16),
                             tests::settings(64, 50)));
    };
    const auto one_sided = tests::cloth(
        [](const IncidentDirection& in, const glm::dvec3& out, size_t) {
            return (in.side == Side::front) == (out.z > 0) && out.z > 0 ? 0.5 * out.z / kPi : 0.0;
        },
        0.0);
    const Picture face = picture(garment, one_sided), back = picture(turned, one_sided);
    EXPECT_NEAR(face.mean(), 0.5, 5e-3 + 4 * face.error());
    EXPECT_LT(back.mean(), 5e-3);
    const Picture plain = picture(garment, tests::diffuse(0.5f));
    const Picture reversed = picture(turned, tests::diffuse(0.5f));
    EXPECT_NEAR(plain.mean(), reversed.mean(), 4 * std::hypot(plain.error(), reversed.error()));
}

/// A sky of radiance 1 but for one pixel of radiance `hot`.
std::shared_ptr<Light> sky_with_hot_pixel(int width, int height, size_t place, float hot) {
    Image image(width, height, {"R", "G", "B"});
    for (auto& plane : image.data) {
        plane.assign(plane.size(), 1);
        plane[place] = hot;
    }
    const tests::TemporaryFolder folder;
    write_exr(image, folder / "sky.exr");
    Params params("test", "infinite", 1);
    params.add({.type = "string", .name = "filename", .numbers = {}, .strings = {"sky.exr"}});
    return make_light("infinite", {params, folder.path(), glm::mat4(1)});
}

Picture white_ground(const std::shared_ptr<Light>& sky) {
    return Picture(Scene({tests::surface(tests::level_square(1, 0), tests::diffuse(1))}, {sky},
                         tests::parallel_camera({0, 0, 2}, {0, 0, 0}, 0.9f, 32),
                         tests::settings(128, 1)));
}

/// One pixel among 10⁶ shines with as much light as all others. In the square image pixels have
/// equal solid angles, and what bilinear lookup spreads of one stays so near that it arrives from
/// one direction.
TEST(HotPixel, AmongAMillionIsSampledByItsLight) {
    constexpr int kSize = 1024, kX = 768, kY = 512;
    constexpr float kHot = 1e6f;
    const std::shared_ptr<Light> sky =
        sky_with_hot_pixel(kSize, kSize, size_t{kY} * kSize + kX, kHot);
    const glm::dvec3 towards = octahedral_to_sphere(glm::dvec2(kX + 0.5, kY + 0.5) / double{kSize});
    const double radiance = 1 + (kHot - 1) * 4 / square(double{kSize}) * towards.z;
    const Picture picture = white_ground(sky);
    EXPECT_NEAR(picture.mean(), radiance, 4 * picture.error() + 1e-3 * radiance);
    // Flat cells sample the tent of the hot pixel with E[w²] = 1.444² (in each dimension, ¾ of the
    // light lies in the middle cell, where E[w²] is 28/27, and ¼ in those beside it, 8/3). It makes
    // 0.74 of the radiance; the even rest is below the mean and left to the BSDF, which finds it
    // without noise: 0.74² · (2.09 − 1) = 0.60 per candidate, of which a sample has two.
    const double noise = std::sqrt(picture.mean("variance.G")) / picture.mean();
    EXPECT_LT(noise, std::sqrt(0.60 / 2 / 128));
    const Picture even = white_ground(sky_with_hot_pixel(kSize, kSize, 0, 1));
    EXPECT_NEAR(even.mean(), 1, 4 * even.error() + 1e-3);
}

/// One pixel of the sky is 10⁶ times as bright as the others, as a sun is: sampled by luminance it
/// makes no more noise than the rest.
TEST(HotPixel, IsSampledByItsLight) {
    const std::shared_ptr<Light> sky = sky_with_hot_pixel(64, 32, 8 * 64 + 20, 1e6f);
    // Irradiance on the level ground, by midpoints.
    constexpr int kSteps = 1024;
    double irradiance = 0;
    for (int j = 0; j < kSteps; ++j)
        for (int i = 0; i < 2 * kSteps; ++i) {
            const double theta = kPi / 2 * (j + 0.5) / kSteps, phi = kPi * (i + 0.5) / kSteps;
            irradiance += sky->escaped(glm::vec3(spherical_direction(theta, phi))).radiance.g *
                          std::cos(theta) * std::sin(theta) * square(kPi) /
                          (2 * square(double{kSteps}));
        }
    const Picture picture = white_ground(sky);
    EXPECT_NEAR(picture.mean(), irradiance / kPi, 4 * picture.error() + 1e-3 * irradiance);
    const double noise = std::sqrt(picture.mean("variance.G")) / picture.mean();
    // Flat cells sample the tent that bilinear lookup makes of a pixel: a deviation of about 1 per
    // sample, 0.09 for 128. By the cosine alone, which hits it once in 500 samples, it is more
    // than 1.4.
    EXPECT_LT(noise, 0.106);
}

} // namespace
} // namespace rapport
