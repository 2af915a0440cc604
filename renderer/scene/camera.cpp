#include "renderer/scene/camera.h"

#include <algorithm>

namespace rapport {
namespace {

/// The part of the screen that is on the film: x0, x1, y0, y1.
glm::vec4 screen_window(const Camera& camera) {
    const glm::vec2 size(camera.resolution);
    const glm::vec2 half = size / std::min(size.x, size.y);
    return camera.screen_window == glm::vec4(0) ? glm::vec4(-half.x, half.x, -half.y, half.y)
                                                : camera.screen_window;
}

} // namespace

CameraRays::CameraRays(const Camera& camera) {
    const glm::vec2 size(camera.resolution);
    const glm::vec4 window = screen_window(camera);
    // Film to screen: x from left to right, y from the top, which is the window's upper end.
    const glm::mat3 screen((window.y - window.x) / size.x, 0, 0, //
                           0, (window.z - window.w) / size.y, 0, //
                           window.x, window.w, 1);
    const glm::mat3 axes(camera.to_world);
    from_eye_ = camera.kind == Camera::Kind::perspective;
    eye_ = glm::vec3(camera.to_world[3]);
    forward_ = glm::normalize(axes[2]);
    if (from_eye_) {
        const float scale = std::tan(radians(camera.fov_degrees) / 2);
        direction_ = axes * glm::mat3(scale, 0, 0, 0, scale, 0, 0, 0, 1) * screen;
    } else {
        origin_ = axes * glm::mat3(1, 0, 0, 0, 1, 0, 0, 0, 0) * screen;
        direction_ = glm::mat3(glm::vec3(0), glm::vec3(0), axes[2]);
    }
}

kernel::Ray CameraRays::operator()(const glm::vec2& pixel) const {
    const glm::vec3 film(pixel, 1);
    const glm::vec3 direction = glm::normalize(direction_ * film);
    return {from_eye_ ? eye_ : eye_ + origin_ * film, direction};
}

double Camera::seen_length(const glm::dvec3& a, const glm::dvec3& b) const {
    const glm::dvec3 eye(to_world[3]), along = b - a;
    const double length = glm::length(along);
    const glm::dvec4 window(rapport::screen_window(*this));
    const double pixel = std::min((window.y - window.x) / resolution.x * glm::length(to_world[0]),
                                  (window.w - window.z) / resolution.y * glm::length(to_world[1]));
    if (!(length > 0))
        return 0;
    if (kind == Kind::orthographic)
        return length / pixel;
    const double place = std::clamp(glm::dot(eye - a, along) / (length * length), 0.0, 1.0);
    const double distance = glm::distance(eye, a + place * along) / glm::length(to_world[2]);
    return length / (distance * pixel * std::tan(radians(double{fov_degrees}) / 2));
}

ViewVolume::ViewVolume(const Camera& camera) {
    const glm::dvec4 window(screen_window(camera));
    const bool perspective = camera.kind == Camera::Kind::perspective;
    const double scale = perspective ? std::tan(radians(double{camera.fov_degrees}) / 2) : 1;
    // In camera space a ray is at scale·window·z where it is at z, or at window everywhere.
    const auto side = [&](int axis, double sign, double edge) {
        glm::dvec4 plane(0);
        plane[axis] = sign;
        plane[perspective ? 2 : 3] = -sign * scale * edge;
        return plane;
    };
    planes_ = {side(0, 1, window.x), side(0, -1, window.y), side(1, 1, window.z),
               side(1, -1, window.w), glm::dvec4(0, 0, 1, 0)};
    const glm::dmat4 to_camera = glm::inverse(glm::dmat4(camera.to_world));
    for (glm::dvec4& plane : planes_) {
        plane = plane * to_camera;
        plane /= glm::length(glm::dvec3(plane));
    }
}

bool ViewVolume::may_show(const glm::dvec3& a, const glm::dvec3& b) const {
    const double length = glm::distance(a, b);
    return std::ranges::all_of(planes_, [&](const glm::dvec4& plane) {
        return std::max(glm::dot(plane, glm::dvec4(a, 1)), glm::dot(plane, glm::dvec4(b, 1))) >=
               -length;
    });
}

kernel::Ray Camera::ray(const glm::vec2& pixel) const { return CameraRays(*this)(pixel); }

} // namespace rapport
