#include "renderer/scene/model_scene.h"

#include "renderer/core/error.h"
#include "renderer/scene/gltf/gltf.h"

#include <algorithm>
#include <limits>

namespace rapport {
namespace {

constexpr float kAzimuth = 30, kElevation = 12; ///< of the camera [degrees]
constexpr float kFov = 30;                      ///< [degrees], of the shorter side
constexpr float kMargin = 1.06f;
constexpr float kSky = 0.5f; ///< radiance
// The lamp is a square, as wide as several bins of a table, lest their edges show on the cloth; it
// stands behind the camera, out of the picture.
constexpr float kLampDistance = 10;     ///< from the model's centre, in radii of the model
constexpr float kLampHalfAngle = 10;    ///< under which it is seen from there [degrees]
constexpr float kLampIrradiance = 1.6f; ///< there, on what faces it

class ParamsMaker {
  public:
    ParamsMaker(const std::filesystem::path& path, const std::string& owner)
        : params_(path.string(), owner, 0) {}
    ParamsMaker& text(const std::string& name, const std::string& value) {
        return add("string", name, {}, {value});
    }
    ParamsMaker& grey(const std::string& name, double value) {
        return add("rgb", name, {value, value, value}, {});
    }
    ParamsMaker& points(const std::string& name, const std::vector<glm::vec3>& points) {
        std::vector<double> numbers;
        for (const glm::vec3& p : points)
            numbers.insert(numbers.end(), {p.x, p.y, p.z});
        return add("point3", name, std::move(numbers), {});
    }
    ParamsMaker& integers(const std::string& name, std::vector<double> numbers) {
        return add("integer", name, std::move(numbers), {});
    }
    Params done() { return std::move(params_); }

  private:
    ParamsMaker& add(const std::string& type, const std::string& name, std::vector<double> numbers,
                     std::vector<std::string> strings) {
        params_.add({type, name, std::move(numbers), std::move(strings), 0, 0});
        return *this;
    }
    Params params_;
};

/// Unit vector towards azimuth (from +z towards +x) and elevation above the x–z plane, in degrees.
glm::vec3 around_y(float azimuth, float elevation) {
    const float a = radians(azimuth), e = radians(elevation);
    return {std::cos(e) * std::sin(a), std::sin(e), std::cos(e) * std::cos(a)};
}

struct Bounds {
    glm::vec3 low{std::numeric_limits<float>::infinity()};
    glm::vec3 high = -low;

    glm::vec3 centre() const { return 0.5f * (low + high); }
    float radius() const { return 0.5f * glm::length(high - low); }
};

Bounds bounds_of(const GltfModel& model) {
    Bounds bounds;
    for (const GltfPart& part : model.parts)
        for (const glm::vec3& p : part.mesh.positions) {
            bounds.low = glm::min(bounds.low, p);
            bounds.high = glm::max(bounds.high, p);
        }
    return bounds;
}

/// Looks against `towards_camera`, upright, as near as the frame holds every vertex.
Camera frame_model(const GltfModel& model, const glm::vec3& centre, const glm::vec3& towards_camera,
                   const glm::ivec2& resolution) {
    const glm::vec3 forward = -towards_camera;
    // Right-handed geometry is seen unmirrored when right = forward × up.
    const glm::vec3 right = glm::normalize(glm::cross(forward, glm::vec3(0, 1, 0)));
    const glm::vec3 up = glm::cross(right, forward);
    const glm::vec2 size(resolution);
    const glm::vec2 tangent =
        std::tan(radians(kFov) / 2) / kMargin * size / std::min(size.x, size.y);
    float distance = 0;
    for (const GltfPart& part : model.parts)
        for (const glm::vec3& p : part.mesh.positions) {
            const glm::vec3 offset = p - centre;
            const float across = std::max(std::abs(glm::dot(offset, right)) / tangent.x,
                                          std::abs(glm::dot(offset, up)) / tangent.y);
            distance = std::max(distance, across - glm::dot(offset, forward));
        }
    Camera camera;
    camera.resolution = resolution;
    camera.fov_degrees = kFov;
    camera.to_world = glm::mat4(glm::vec4(right, 0), glm::vec4(up, 0), glm::vec4(forward, 0),
                                glm::vec4(centre - distance * forward, 1));
    return camera;
}

/// A square that faces the model from where `towards_lamp` points.
ShapeDescription lamp(const std::filesystem::path& path, const Bounds& bounds,
                      const glm::vec3& towards_lamp) {
    const float distance = kLampDistance * bounds.radius();
    const float half_side = distance * std::tan(radians(kLampHalfAngle));
    const glm::vec3 centre = bounds.centre() + distance * towards_lamp;
    const glm::vec3 right =
        half_side * glm::normalize(glm::cross(glm::vec3(0, 1, 0), towards_lamp));
    const glm::vec3 up = glm::cross(right, -towards_lamp);
    const double solid_angle = square(2 * half_side / distance); // but for the slant of its corners
    ShapeDescription shape;
    shape.type = "trianglemesh";
    shape.params = ParamsMaker(path, "the lamp")
                       .points("P", {centre - right - up, centre + right - up, centre + right + up,
                                     centre - right + up})
                       .integers("indices", {0, 2, 1, 0, 3, 2})
                       .done();
    shape.area_light =
        ParamsMaker(path, "the lamp's light").grey("L", kLampIrradiance / solid_angle).done();
    return shape;
}

} // namespace

SceneDescription describe_model(const std::filesystem::path& path, const glm::ivec2& resolution) {
    const auto shared = std::make_shared<const GltfModel>(read_gltf(path));
    const GltfModel& model = *shared;
    if (std::ranges::all_of(model.parts,
                            [](const GltfPart& part) { return part.mesh.positions.empty(); }))
        throw FileError(path.string(), "", "a model with triangles", "none");
    SceneDescription scene;
    scene.path = path;
    const Bounds bounds = bounds_of(model);
    scene.camera = frame_model(model, bounds.centre(), around_y(kAzimuth, kElevation), resolution);
    scene.lights = {{"infinite", ParamsMaker(path, "the sky").grey("L", kSky).done()}};
    scene.shapes.push_back(lamp(path, bounds, around_y(kAzimuth - 50, 45)));

    ShapeDescription shape;
    shape.type = "gltf";
    shape.params = ParamsMaker(path, "the model").text("filename", path.filename().string()).done();
    shape.model = shared;
    scene.shapes.push_back(std::move(shape));
    return scene;
}

} // namespace rapport
