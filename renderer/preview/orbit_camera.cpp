#include "renderer/preview/orbit_camera.h"

#include <algorithm>
#include <glm/gtc/matrix_transform.hpp>

namespace rapport {
namespace {

constexpr float kLeastPolarAngle = 0.02f; ///< between the view and the vertical [radians]
constexpr float kMargin = 1.05f;          ///< about a framed subject

/// The axis of the world, of either sign, that is nearest to `direction`.
glm::vec3 nearest_axis(const glm::vec3& direction) {
    const glm::vec3 size = glm::abs(direction);
    const int axis = size.y >= size.x && size.y >= size.z ? 1 : size.z >= size.x ? 2 : 0;
    glm::vec3 nearest(0);
    nearest[axis] = std::copysign(1.0f, direction[axis]);
    return nearest;
}

} // namespace

OrbitCamera::OrbitCamera(const Camera& camera, const Box& subject) : camera_(camera) {
    up_ = nearest_axis(axis(1));
    const float along = glm::dot(subject.centre() - eye(), axis(2));
    target_ = eye() + std::max(along, 0.1f * std::max(subject.radius(), 1e-3f)) * axis(2);
}

void OrbitCamera::resize(const glm::ivec2& resolution) {
    camera_.resolution = glm::max(resolution, 1);
    glm::vec4& window = camera_.screen_window;
    if (window == glm::vec4(0))
        return;
    // The scene's own window keeps its height.
    const float aspect = static_cast<float>(camera_.resolution.x) / camera_.resolution.y;
    const float middle = 0.5f * (window.x + window.y);
    const float half = 0.5f * aspect * (window.w - window.z);
    window.x = middle - half;
    window.y = middle + half;
}

float OrbitCamera::pixel_size() const {
    const glm::vec4& window = camera_.screen_window;
    const glm::ivec2& size = camera_.resolution;
    const float screen =
        window == glm::vec4(0) ? 2.0f / std::min(size.x, size.y) : (window.y - window.x) / size.x;
    return camera_.kind == Camera::Kind::perspective
               ? screen * std::tan(radians(camera_.fov_degrees) / 2) * distance()
               : screen * glm::length(glm::vec3(camera_.to_world[0]));
}

void OrbitCamera::turn(float angle, const glm::vec3& about) {
    const glm::mat4 there = glm::translate(glm::mat4(1), target_);
    const glm::mat4 back = glm::translate(glm::mat4(1), -target_);
    camera_.to_world = there * glm::rotate(glm::mat4(1), angle, about) * back * camera_.to_world;
}

void OrbitCamera::move(const glm::vec3& by) {
    camera_.to_world[3] += glm::vec4(by, 0);
    target_ += by;
}

void OrbitCamera::orbit(const glm::vec2& pixels) {
    const glm::ivec2& size = camera_.resolution;
    const glm::vec2 angle =
        pixels * static_cast<float>(kPi) / static_cast<float>(std::min(size.x, size.y));
    // Camera space is right-handed or, under a mirror image, left-handed.
    const float hand = glm::dot(glm::cross(axis(2), axis(1)), axis(0)) > 0 ? 1.0f : -1.0f;
    turn(-hand * angle.x, up_);
    const float polar = std::acos(std::clamp(glm::dot(-axis(2), up_), -1.0f, 1.0f));
    const float wanted =
        std::clamp(polar - angle.y, kLeastPolarAngle, static_cast<float>(kPi) - kLeastPolarAngle);
    turn(hand * (wanted - polar), axis(0));
}

void OrbitCamera::pan(const glm::vec2& pixels) {
    move(pixel_size() * (pixels.y * axis(1) - pixels.x * axis(0)));
}

void OrbitCamera::zoom(float factor) {
    if (camera_.kind == Camera::Kind::perspective) {
        const float before = distance();
        camera_.to_world[3] += glm::vec4((before - before / factor) * axis(2), 0);
        return;
    }
    camera_.to_world[0] /= factor;
    camera_.to_world[1] /= factor;
}

void OrbitCamera::focus(const glm::vec3& point) {
    const glm::vec3 offset = point - target_;
    move(offset - glm::dot(offset, axis(2)) * axis(2));
    target_ = point;
}

void OrbitCamera::frame(const Box& subject) {
    focus(subject.centre());
    const float radius = kMargin * std::max(subject.radius(), 1e-6f);
    if (camera_.kind == Camera::Kind::perspective) {
        const float away = radius / std::sin(radians(camera_.fov_degrees) / 2);
        camera_.to_world[3] = glm::vec4(target_ - away * axis(2), 1);
        return;
    }
    const glm::ivec2& size = camera_.resolution;
    zoom(pixel_size() * std::min(size.x, size.y) / (2 * radius));
}

} // namespace rapport
