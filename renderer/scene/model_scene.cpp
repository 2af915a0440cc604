#include "renderer/scene/model_scene.h"

#include "renderer/core/error.h"
#include "renderer/scene/gltf.h"

#include <algorithm>
#include <limits>

namespace rapport {
namespace {

constexpr float kAzimuth = 30, kElevation = 12; ///< of the camera [degrees]
constexpr float kFov = 30;                      ///< [degrees], of the shorter side
constexpr float kMargin = 1.06f;
constexpr float kSky = 0.5f, kSun = 1.6f; ///< radiance and irradiance
constexpr float kGrey = 0.5f;

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
    ParamsMaker& point(const std::string& name, const glm::vec3& p) {
        return add("point3", name, {p.x, p.y, p.z}, {});
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

/// Looks against `towards_camera`, upright, as near as the frame holds every vertex.
Camera frame_model(const GltfModel& model, const glm::vec3& towards_camera,
                   const glm::ivec2& resolution) {
    glm::vec3 low(std::numeric_limits<float>::infinity()), high = -low;
    for (const GltfPart& part : model.parts)
        for (const glm::vec3& p : part.mesh.positions) {
            low = glm::min(low, p);
            high = glm::max(high, p);
        }
    const glm::vec3 centre = 0.5f * (low + high), forward = -towards_camera;
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

} // namespace

SceneDescription describe_model(const std::filesystem::path& path, const glm::ivec2& resolution) {
    const GltfModel model = read_gltf(path);
    if (std::ranges::all_of(model.parts,
                            [](const GltfPart& part) { return part.mesh.positions.empty(); }))
        throw FileError(path.string(), "", "a model with triangles", "none");
    SceneDescription scene;
    scene.path = path;
    scene.camera = frame_model(model, around_y(kAzimuth, kElevation), resolution);

    LightDescription sky{"infinite", ParamsMaker(path, "the sky").grey("L", kSky).done()};
    LightDescription sun{"distant", ParamsMaker(path, "the sun")
                                        .grey("L", kSun)
                                        .point("from", around_y(kAzimuth - 50, 45))
                                        .point("to", glm::vec3(0))
                                        .done()};
    scene.lights = {std::move(sky), std::move(sun)};

    auto grey = std::make_shared<MaterialDescription>();
    grey->params = ParamsMaker(path, "the grey").grey("reflectance", kGrey).done();
    ShapeDescription shape;
    shape.type = "gltf";
    shape.params = ParamsMaker(path, "the model").text("filename", path.filename().string()).done();
    shape.material = std::move(grey);
    scene.shapes.push_back(std::move(shape));
    return scene;
}

} // namespace rapport
