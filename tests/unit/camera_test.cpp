#include "renderer/scene/camera.h"

#include <glm/gtc/matrix_transform.hpp>
#include <gtest/gtest.h>

namespace rapport {
namespace {

void expect_near(const glm::vec3& a, const glm::vec3& b, float tolerance = 1e-5f) {
    EXPECT_LT(glm::length(a - b), tolerance) << a.x << ' ' << a.y << ' ' << a.z;
}

TEST(Camera, PerspectiveSpansTheFieldOfViewAlongTheShorterSide) {
    Camera camera;
    camera.fov_degrees = 60;
    camera.resolution = {400, 200};
    const float t = std::tan(radians(30.0f));
    expect_near(camera.ray({200, 100}).dir, {0, 0, 1});
    expect_near(camera.ray({200, 0}).dir, glm::normalize(glm::vec3(0, t, 1)));
    expect_near(camera.ray({200, 200}).dir, glm::normalize(glm::vec3(0, -t, 1)));
    expect_near(camera.ray({400, 100}).dir, glm::normalize(glm::vec3(2 * t, 0, 1)));
    expect_near(camera.ray({0, 100}).dir, glm::normalize(glm::vec3(-2 * t, 0, 1)));

    camera.resolution = {200, 400};
    expect_near(camera.ray({200, 200}).dir, glm::normalize(glm::vec3(t, 0, 1)));
    expect_near(camera.ray({100, 0}).dir, glm::normalize(glm::vec3(0, 2 * t, 1)));
}

TEST(Camera, OrthographicRaysAreParallel) {
    Camera camera;
    camera.kind = Camera::Kind::orthographic;
    camera.screen_window = {-3, 1, -2, 5};
    camera.resolution = {100, 50};
    for (const auto& [pixel, origin] : {std::pair{glm::vec2(0, 0), glm::vec3(-3, 5, 0)},
                                        {glm::vec2(100, 50), glm::vec3(1, -2, 0)},
                                        {glm::vec2(50, 25), glm::vec3(-1, 1.5f, 0)}}) {
        expect_near(camera.ray(pixel).org, origin);
        expect_near(camera.ray(pixel).dir, {0, 0, 1});
    }
}

TEST(Camera, FollowsItsTransformation) {
    Camera camera;
    camera.resolution = {100, 100};
    // At (1, 2, 3), looking along −x, with y to the right in the picture and z up; scaled by 10,
    // which changes neither the place nor the directions of a perspective.
    camera.to_world = glm::mat4(glm::vec4(0, 10, 0, 0), glm::vec4(0, 0, 10, 0),
                                glm::vec4(-10, 0, 0, 0), glm::vec4(1, 2, 3, 1));
    expect_near(camera.ray({50, 50}).org, {1, 2, 3});
    expect_near(camera.ray({50, 50}).dir, {-1, 0, 0});
    expect_near(camera.ray({100, 50}).dir, glm::normalize(glm::vec3(-1, 1, 0)));
    expect_near(camera.ray({50, 0}).dir, glm::normalize(glm::vec3(-1, 0, 1)));
    EXPECT_NEAR(CameraRays(camera).depth({-4, 100, -7}), 5, 1e-4f);
}

TEST(Camera, SeenLengthIsThatOnTheFilmWhereASegmentStandsSquare) {
    Camera camera;
    camera.resolution = {400, 200};
    camera.fov_degrees = 60;
    camera.to_world = glm::translate(glm::mat4(1), glm::vec3(1, 2, 3));
    const glm::dvec3 eye(1, 2, 3);
    const double pixel = 2 * std::tan(radians(30.0)) / 200; // at distance 1
    EXPECT_NEAR(camera.seen_length(eye + glm::dvec3(0, 0, 5), eye + glm::dvec3(0.5, 0, 5)),
                0.1 / pixel, 1e-4);
    EXPECT_NEAR(camera.seen_length(eye + glm::dvec3(0, 0, 5), eye + glm::dvec3(0, 0, 7)),
                2 / 5.0 / pixel, 1e-3); // at its nearest point
    EXPECT_EQ(camera.seen_length(eye, eye), 0);
    EXPECT_TRUE(std::isinf(camera.seen_length(eye, eye + glm::dvec3(1, 0, 0))));
    camera.to_world = glm::scale(camera.to_world, glm::vec3(7)); // changes nothing but the unit
    EXPECT_NEAR(camera.seen_length(eye + glm::dvec3(0, 0, 5), eye + glm::dvec3(0.5, 0, 5)),
                0.1 / pixel, 1e-4);
    camera.kind = Camera::Kind::orthographic;
    EXPECT_NEAR(camera.seen_length(eye, eye + glm::dvec3(0, 0, 7)), 100, 1e-4);
}

TEST(ViewVolume, IsThePictureAndAsMuchRoundASegmentAsItIsLong) {
    Camera camera;
    camera.resolution = {400, 200};
    camera.fov_degrees = 60;
    // At (1, 2, 3), looking along −x, with y to the right and z up, as in FollowsItsTransformation.
    camera.to_world = glm::mat4(glm::vec4(0, 10, 0, 0), glm::vec4(0, 0, 10, 0),
                                glm::vec4(-10, 0, 0, 0), glm::vec4(1, 2, 3, 1));
    /// An upright segment of `length` about a place right of, above and before the eye.
    const auto shows = [&](double right, double up, double before, double length) {
        const glm::dvec3 place(1 - before, 2 + right, 3 + up), half(0, 0, length / 2);
        return ViewVolume(camera).may_show(place - half, place + half);
    };
    const double t = std::tan(radians(30.0));
    for (const double sign : {-1, 1}) {
        EXPECT_TRUE(shows(sign * 2 * t * 5, 0, 5, 1e-3)); // the sides of the picture, 2:1
        EXPECT_FALSE(shows(sign * 2.1 * t * 5, 0, 5, 1e-3));
        EXPECT_TRUE(shows(0, sign * t * 5, 5, 1e-3));
        EXPECT_FALSE(shows(0, sign * 1.1 * t * 5, 5, 1e-3));
    }
    EXPECT_FALSE(shows(0, 0, -1, 0.9)); // behind the eye
    EXPECT_TRUE(shows(0, 0, -1, 1.1));
    const double apart = std::hypot(1, 2 * t); // moves it by 1 m off the right side
    EXPECT_TRUE(shows(2 * t * 5 + 0.99 * apart, 0, 5, 1));
    EXPECT_FALSE(shows(2 * t * 5 + 1.01 * apart, 0, 5, 1));

    camera.kind = Camera::Kind::orthographic;
    camera.screen_window = {-3, 1, -2, 5}; // times the scale of 10
    EXPECT_TRUE(shows(-30, 0, 500, 1e-3));
    EXPECT_FALSE(shows(-30.1, 0, 500, 1e-3));
    EXPECT_TRUE(shows(10, 50, 500, 1e-3));
    EXPECT_FALSE(shows(10.1, 0, 500, 1e-3));
    EXPECT_FALSE(shows(0, -20.1, 500, 1e-3));
    EXPECT_FALSE(shows(0, 0, -1, 0.5));
}

} // namespace
} // namespace rapport
