#pragma once

#include "renderer/kernel/scene.h"

#include <array>

namespace rapport {

/// Perspective or orthographic, as in pbrt: the screen window spans [−1, 1] along the shorter side
/// of the film.
struct Camera {
    enum class Kind { perspective, orthographic } kind = Kind::perspective;
    glm::mat4 to_world{1};      ///< camera space: x right, y up, looking along +z
    float fov_degrees = 90;     ///< of the shorter side; perspective only
    glm::vec4 screen_window{0}; ///< x0, x1, y0, y1; all 0 = from the aspect ratio
    glm::ivec2 resolution{1280, 720};

    bool operator==(const Camera&) const = default;

    /// The unit-direction ray through film position `pixel` (continuous, y down).
    kernel::Ray ray(const glm::vec2& pixel) const;
    /// Length in pixels of the segment from `a` to `b` if it stood square to the view at its
    /// nearest point: no less than it is seen to be, and the same from whatever side. Infinite
    /// where it touches the eye.
    double seen_length(const glm::dvec3& a, const glm::dvec3& b) const;
};

/// Generates a camera's rays; all that does not depend on the pixel is worked out once.
class CameraRays {
  public:
    explicit CameraRays(const Camera& camera);
    kernel::Ray operator()(const glm::vec2& pixel) const;
    /// Of a world-space point: along the viewing direction, in world units.
    float depth(const glm::vec3& point) const { return glm::dot(point - eye_, forward_); }

  private:
    // A ray starts at eye + origin·(x, y) and runs along direction·(x, y, 1); one of the two
    // matrices does not vary with the pixel.
    bool from_eye_; ///< as all rays of a perspective do
    glm::vec3 eye_, forward_;
    glm::mat3 origin_, direction_;
};

/// What of the world a camera can have in its picture; all that does not depend on the place is
/// worked out once.
class ViewVolume {
  public:
    explicit ViewVolume(const Camera& camera);
    /// Whether the segment from `a` to `b`, or anything no farther from it than it is long, may be
    /// in the picture: with an edge also the faces of which it is the longest.
    bool may_show(const glm::dvec3& a, const glm::dvec3& b) const;

  private:
    /// Unit normal, inwards, and offset: the sides of the picture and the eye's own plane.
    std::array<glm::dvec4, 5> planes_;
};

/// How large a camera sees things, for those who make them no finer than that.
class Sight {
  public:
    explicit Sight(const Camera& camera) : camera_(camera), volume_(camera) {}
    /// Camera::seen_length, or an eighth of it where the picture does not show the segment: what is
    /// out there casts shadows and is met by scattered light, but its outline is in no picture.
    double length(const glm::dvec3& a, const glm::dvec3& b) const {
        return (volume_.may_show(a, b) ? 1.0 : 1.0 / 8) * camera_.seen_length(a, b);
    }

  private:
    Camera camera_;
    ViewVolume volume_;
};

} // namespace rapport
