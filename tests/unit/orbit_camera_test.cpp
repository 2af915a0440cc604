#include "renderer/preview/orbit_camera.h"
#include "tests/support/temporary_folder.h"

#include "renderer/preview/camera_file.h"
#include "renderer/scene/pbrt/pbrt_parser.h"
#include "tests/support/file_bytes.h"

#include <algorithm>
#include <glm/gtc/matrix_transform.hpp>
#include <gtest/gtest.h>

namespace rapport {
namespace {

const Box kUnitBox{glm::vec3(-1), glm::vec3(1)};

/// At (0, 0, 5), looking at the origin, right-handed; or seen in a mirror, as pbrt sees it.
Camera camera(bool mirrored = false, Camera::Kind kind = Camera::Kind::perspective) {
    Camera camera;
    camera.kind = kind;
    camera.fov_degrees = 40;
    camera.resolution = {200, 100};
    camera.to_world = glm::mat4(glm::vec4(mirrored ? -1 : 1, 0, 0, 0), glm::vec4(0, 1, 0, 0),
                                glm::vec4(0, 0, -1, 0), glm::vec4(0, 0, 5, 1));
    return camera;
}

/// Where a point is seen, in pixels.
glm::vec2 seen(const Camera& camera, const glm::vec3& point) {
    const glm::vec4 local = glm::inverse(camera.to_world) * glm::vec4(point, 1);
    const float depth = camera.kind == Camera::Kind::perspective
                            ? local.z * std::tan(radians(camera.fov_degrees) / 2)
                            : 1;
    const glm::vec2 size(camera.resolution);
    const float half = 0.5f * std::min(size.x, size.y);
    return 0.5f * size + half * glm::vec2(local.x, -local.y) / depth;
}

void expect_near(const glm::vec2& a, const glm::vec2& b, float tolerance) {
    EXPECT_NEAR(a.x, b.x, tolerance);
    EXPECT_NEAR(a.y, b.y, tolerance);
}

TEST(OrbitCamera, TurnsTheSubjectAlongWithTheMouse) {
    for (const bool mirrored : {false, true}) {
        OrbitCamera orbit(camera(mirrored), kUnitBox);
        const glm::vec3 facing(0, 0, 1); // the point of the subject that faces the camera
        orbit.orbit({5, 0});
        EXPECT_GT(seen(orbit.camera(), facing).x, 101);
        EXPECT_NEAR(seen(orbit.camera(), facing).y, 50, 0.5f);
        orbit.orbit({-5, 0});
        orbit.orbit({0, 5});
        EXPECT_GT(seen(orbit.camera(), facing).y, 51);
        expect_near(seen(orbit.camera(), glm::vec3(0)), {100, 50}, 0.01f);
        EXPECT_NEAR(glm::length(glm::vec3(orbit.camera().to_world[3])), 5, 1e-4f);
    }
}

TEST(OrbitCamera, NeverGetsOverThePoles) {
    OrbitCamera orbit(camera(), kUnitBox);
    for (int i = 0; i < 50; ++i)
        orbit.orbit({1, 20});
    EXPECT_GT(orbit.camera().to_world[3].y, 4.9f);
    EXPECT_GT(orbit.camera().to_world[1].y, 0); // still upright
    for (int i = 0; i < 100; ++i)
        orbit.orbit({1, -20});
    EXPECT_LT(orbit.camera().to_world[3].y, -4.9f);
    EXPECT_GT(orbit.camera().to_world[1].y, 0);
}

TEST(OrbitCamera, MovesByPixels) {
    for (const Camera::Kind kind : {Camera::Kind::perspective, Camera::Kind::orthographic})
        for (const bool mirrored : {false, true}) {
            OrbitCamera orbit(camera(mirrored, kind), kUnitBox);
            const glm::vec2 before = seen(orbit.camera(), glm::vec3(0));
            orbit.pan({12, -7});
            expect_near(seen(orbit.camera(), glm::vec3(0)), before + glm::vec2(12, -7), 0.01f);
            const glm::vec3 point = glm::vec3(0.3f, -0.2f, 0);
            orbit.focus(point);
            expect_near(seen(orbit.camera(), point), {100, 50}, 0.01f);
            const glm::vec2 corner = seen(orbit.camera(), point + glm::vec3(0.1f, 0, 0));
            orbit.zoom(2);
            expect_near(seen(orbit.camera(), point + glm::vec3(0.1f, 0, 0)) - glm::vec2(100, 50),
                        2.0f * (corner - glm::vec2(100, 50)), 0.1f);
        }
}

TEST(OrbitCamera, FramesAll) {
    for (const Camera::Kind kind : {Camera::Kind::perspective, Camera::Kind::orthographic}) {
        OrbitCamera orbit(camera(false, kind), kUnitBox);
        const Box small{glm::vec3(2, 2, 2), glm::vec3(2.2f, 2.3f, 2.1f)};
        orbit.frame(small);
        float farthest = 0;
        for (int corner = 0; corner < 8; ++corner) {
            const glm::vec3 p(corner & 1 ? 2.2f : 2, corner & 2 ? 2.3f : 2, corner & 4 ? 2.1f : 2);
            const glm::vec2 offset = glm::abs(seen(orbit.camera(), p) - glm::vec2(100, 50));
            EXPECT_LE(offset.y, 50);
            farthest = std::max(farthest, glm::length(offset));
        }
        EXPECT_GT(farthest, 25);
    }
}

TEST(CameraFile, ACopyIsSeenFromTheNewPlace) {
    const tests::TemporaryFolder folder;
    tests::write_bytes(folder / "a.pbrt",
                       "# Camera \"no\"\nScale -1 1 1 LookAt 1 2 3  0 0 0  0 1 0\n  Camera "
                       "\"perspective\" \"float fov\" 40 # kept\nWorldBegin\n");
    const SceneDescription before = parse_pbrt(folder / "a.pbrt");
    OrbitCamera orbit(before.camera, kUnitBox);
    orbit.orbit({30, 20});
    orbit.pan({3, 4});
    save_camera(orbit.camera(), folder / "a.pbrt", folder / "b.pbrt");
    const SceneDescription after = parse_pbrt(folder / "b.pbrt");
    for (int c = 0; c < 4; ++c)
        for (int r = 0; r < 4; ++r)
            EXPECT_NEAR(after.camera.to_world[c][r], orbit.camera().to_world[c][r], 1e-5f);
    EXPECT_NE(after.camera.to_world, before.camera.to_world);
    EXPECT_EQ(after.camera.fov_degrees, 40);
    EXPECT_NE(tests::read_bytes(folder / "b.pbrt").find("# kept"), std::string::npos);
}

} // namespace
} // namespace rapport
