#pragma once

#include "materials/bsdf.h"
#include "materials/table/table_bsdf.h"
#include "renderer/scene/light/light.h"
#include "renderer/scene/mesh/mesh_operations.h"
#include "renderer/scene/scene.h"
#include "tests/support/synthetic_tables.h"

#include <glm/gtc/matrix_transform.hpp>

// Pieces of scenes whose radiance is known in closed form.

namespace rapport::tests {

inline Param number_param(const std::string& type, const std::string& name,
                          std::vector<double> numbers) {
    Param param;
    param.type = type;
    param.name = name;
    param.numbers = std::move(numbers);
    return param;
}

inline std::shared_ptr<const Bsdf> diffuse(float reflectance) {
    Params params("test", "diffuse", 1);
    params.add(number_param("rgb", "reflectance", {reflectance, reflectance, reflectance}));
    return make_material("diffuse", {params, "", {}});
}

/// A cloth by its table.
inline std::shared_ptr<const Bsdf> cloth_of(std::shared_ptr<const TableBsdf> table) {
    Params params("test", "cloth", 1);
    Param file;
    file.type = "string";
    file.name = "filename";
    file.strings = {"swatch.bsdf"};
    params.add(file);
    return make_material("cloth", {params, "", [&](const auto&, const auto&) { return table; }});
}

/// A cloth whose table scatters by `intensity` and lets `unscattered` pass.
inline std::shared_ptr<const Bsdf> cloth(const Intensity& intensity, double unscattered) {
    return cloth_of(std::make_shared<const TableBsdf>(synthetic_table(intensity, unscattered),
                                                      "synthetic.bsdf"));
}
/// Half of the light passes, the other half is absorbed.
inline std::shared_ptr<const Bsdf> half_open_cloth() {
    static const auto made = cloth([](const auto&, const auto&, size_t) { return 0.0; }, 0.5);
    return made;
}

inline std::shared_ptr<Light> sky(float radiance) {
    Params params("test", "infinite", 1);
    params.add(number_param("rgb", "L", {radiance, radiance, radiance}));
    return make_light("infinite", {params, "", glm::mat4(1)});
}
inline std::shared_ptr<Light> sun(float irradiance, const glm::vec3& towards_light) {
    Params params("test", "distant", 1);
    params.add(number_param("rgb", "L", {irradiance, irradiance, irradiance}));
    params.add(number_param("point3", "from", {towards_light.x, towards_light.y, towards_light.z}));
    params.add(number_param("point3", "to", {0, 0, 0}));
    return make_light("distant", {params, "", glm::mat4(1)});
}

/// A parallelogram whose face side is edge1 × edge2; u runs along edge1, v along edge2.
inline TriangleMesh parallelogram(const glm::vec3& corner, const glm::vec3& edge1,
                                  const glm::vec3& edge2) {
    TriangleMesh mesh;
    mesh.positions = {corner, corner + edge1, corner + edge1 + edge2, corner + edge2};
    mesh.uvs = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
    mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
    return mesh;
}
/// The square |x|, |y| ≤ half at height z, face up.
inline TriangleMesh level_square(float half, float z) {
    return parallelogram({-half, -half, z}, {2 * half, 0, 0}, {0, 2 * half, 0});
}
/// The cube |x|, |y|, |z| ≤ half, faces outwards.
inline TriangleMesh cube(float half) { return box(glm::vec3(-half), glm::vec3(half)); }

inline Surface surface(TriangleMesh mesh, std::shared_ptr<const Bsdf> material,
                       float emission = 0) {
    orient_by_normals(mesh);
    Surface made;
    made.mesh = std::make_shared<const TriangleMesh>(std::move(mesh));
    made.material = std::move(material);
    made.emission = Rgb(emission);
    return made;
}

/// The other side becomes the face.
inline void turn_over(Surface& surface) {
    TriangleMesh mesh = *surface.mesh;
    reverse_orientation(mesh);
    surface.mesh = std::make_shared<const TriangleMesh>(std::move(mesh));
}

/// Parallel rays from `eye` towards `target`, over a square window of half width `half`.
inline Camera parallel_camera(const glm::vec3& eye, const glm::vec3& target, float half,
                              int pixels) {
    const glm::vec3 z = glm::normalize(target - eye);
    const Frame frame = Frame::about(z);
    Camera camera;
    camera.kind = Camera::Kind::orthographic;
    camera.to_world =
        glm::mat4(glm::vec4(frame.x, 0), glm::vec4(frame.y, 0), glm::vec4(z, 0), glm::vec4(eye, 1));
    camera.screen_window = {-half, half, -half, half};
    camera.resolution = {pixels, pixels};
    return camera;
}

inline RenderSettings settings(int samples, int max_depth,
                               Sampler::Kind sampler = Sampler::Kind::independent,
                               uint64_t seed = 0) {
    RenderSettings settings;
    settings.samples = samples;
    settings.max_depth = max_depth;
    settings.sampler = sampler;
    settings.seed = seed;
    return settings;
}

} // namespace rapport::tests
