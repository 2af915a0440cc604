#pragma once

#include "renderer/scene/camera.h"

namespace rapport {

/// An axis-aligned box.
struct Box {
    glm::vec3 low{0}, high{0};

    glm::vec3 centre() const { return 0.5f * (low + high); }
    float radius() const { return 0.5f * glm::length(high - low); }
};

/// A camera that a person moves about a target. It keeps the kind, the handedness and the scale of
/// the scene's own camera; upright is the axis of the world that is nearest to that camera's own
/// up.
class OrbitCamera {
  public:
    /// The target is the point of the optical axis that is nearest to the subject's centre.
    OrbitCamera(const Camera& camera, const Box& subject);

    const Camera& camera() const { return camera_; }
    const glm::vec3& up() const { return up_; }
    void resize(const glm::ivec2& resolution);

    /// As if the subject were taken at a point and turned: pixels to the right and downwards, half
    /// a turn for the film's shorter side. The camera never gets over the poles.
    void orbit(const glm::vec2& pixels);
    /// The subject follows by so many pixels.
    void pan(const glm::vec2& pixels);
    /// Brings the target nearer by `factor`; it is never reached.
    void zoom(float factor);
    /// Makes `point` the target and moves sideways until it is in the middle.
    void focus(const glm::vec3& point);
    /// Makes the subject fill the picture, seen from the same direction.
    void frame(const Box& subject);

  private:
    glm::vec3 eye() const { return glm::vec3(camera_.to_world[3]); }
    glm::vec3 axis(int i) const { return glm::normalize(glm::vec3(camera_.to_world[i])); }
    float distance() const { return glm::dot(target_ - eye(), axis(2)); }
    /// World units that a pixel spans at the target.
    float pixel_size() const;
    void turn(float angle, const glm::vec3& about);
    void move(const glm::vec3& by);

    Camera camera_;
    glm::vec3 target_, up_;
};

} // namespace rapport
