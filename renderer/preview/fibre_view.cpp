#include "renderer/preview/fibre_view.h"

#include "renderer/scene/mesh/mesh_operations.h"

#include <cmath>
#include <glm/gtc/matrix_transform.hpp>

namespace rapport {
namespace {

constexpr int kSamples = 64;  ///< more are not seen at the size that it has in the window
constexpr int kMaxDepth = 12; ///< passages of the swatch
constexpr float kZoomStep = 1.15f;
constexpr float kFov = 30; ///< of the picture's shorter side [degrees]
constexpr float kDistance =
    1.7;                      ///< of the camera: the swatch fills a picture twice as wide as high
constexpr float kTilt = 25;   ///< from the normal at first, towards the weaver [degrees]
constexpr float kSky = 0.25f; ///< radiance
// No path through smooth fibres meets a point: the lamp is a square of some size.
constexpr float kLampDistance = 8, kLampHalfAngle = 15; ///< [half widths, degrees]
constexpr float kLampIrradiance = 5;                    ///< on what faces it

Params grey(const char* name, double value) {
    Params params("fibre view", name, 0);
    params.add({"rgb", name, {value, value, value}, {}, 0, 0});
    return params;
}

Surface lamp(const glm::vec3& light, const std::shared_ptr<const Bsdf>& material) {
    const float half_side = kLampDistance * std::tan(radians(kLampHalfAngle));
    const Frame frame = Frame::about(light);
    const glm::vec3 centre = kLampDistance * light, x = half_side * frame.x,
                    y = half_side * frame.y;
    TriangleMesh mesh;
    mesh.positions = {centre - x - y, centre + x - y, centre + x + y, centre - x + y};
    mesh.triangles = {{0, 2, 1}, {0, 3, 2}}; // their face side looks back at the swatch
    Surface surface;
    surface.mesh = std::make_shared<const TriangleMesh>(std::move(mesh));
    surface.material = material;
    surface.emission = Rgb(kLampIrradiance / square(2 * half_side / kLampDistance));
    return surface;
}

Camera first_camera() {
    const float tilt = radians(kTilt);
    const glm::vec3 back(0, -std::sin(tilt), std::cos(tilt)); // from the swatch to the camera
    const glm::vec3 up(0, std::cos(tilt), std::sin(tilt));
    Camera camera;
    camera.fov_degrees = kFov;
    camera.to_world = glm::mat4(glm::vec4(1, 0, 0, 0), glm::vec4(up, 0), glm::vec4(-back, 0),
                                glm::vec4(kDistance * back, 1));
    return camera;
}

} // namespace

Scene fibre_scene(std::shared_ptr<const FibreSwatch> fibres, const glm::vec3& light) {
    const float to_units = static_cast<float>(1 / fibres->high().x); // from µm
    TriangleMesh mesh =
        box(to_units * glm::vec3(fibres->low()), to_units * glm::vec3(fibres->high()));
    const auto material = make_material("diffuse", {grey("reflectance", 0.5), "", {}});
    Surface swatch;
    swatch.mesh = std::make_shared<const TriangleMesh>(std::move(mesh));
    swatch.material = material;
    swatch.fibres.emplace(std::move(fibres),
                          glm::scale(glm::mat4(1), glm::vec3(1e6f * to_units))); // from metres
    RenderSettings settings;
    settings.max_depth = kMaxDepth;
    return Scene({std::move(swatch), lamp(light, material)},
                 {make_light("infinite", {grey("L", kSky), "", glm::mat4(1)})}, first_camera(),
                 settings);
}

void FibreView::show(std::shared_ptr<const FibreSwatch> fibres, const glm::vec3& light,
                     const glm::ivec2& size) {
    const bool same = fibres == fibres_ && light == light_;
    if (same && size == camera_->camera().resolution)
        return;
    if (!same) {
        fibres_ = std::move(fibres);
        light_ = light;
        scene_ = std::make_shared<const Scene>(fibre_scene(fibres_, light));
    }
    if (!camera_)
        camera_.emplace(scene_->camera, Box{{-1, -1, 0}, {1, 1, 0}});
    camera_->resize(size);
    restart();
}

void FibreView::orbit(const glm::vec2& pixels) {
    camera_->orbit(pixels);
    restart();
}

void FibreView::zoom(float steps) {
    camera_->zoom(std::pow(kZoomStep, steps));
    restart();
}

void FibreView::restart() {
    tracer_.set_samples(kSamples);
    tracer_.show(scene_, camera_->camera());
}

} // namespace rapport
