#pragma once

#include "materials/bsdf.h"
#include "renderer/kernel/scene.h"
#include "renderer/scene/camera.h"
#include "renderer/scene/light.h"
#include "renderer/scene/mesh.h"

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

namespace rapport {

/// One mesh with its material and, if it shines, its emission.
struct Surface {
    TriangleMesh mesh;
    std::shared_ptr<const Bsdf> material;
    Rgb emission{0}; ///< radiance, both sides if `two_sided_emission`
    bool two_sided_emission = false;
    bool flip = false;  ///< ReverseOrientation: the face side is the other one
    float rotation = 0; ///< of the cloth against the UVs [rad], counter-clockwise from the face
    std::shared_ptr<const Light> area_light; ///< set by Scene's constructor where it shines
};

/// What a ray met, ready for shading.
struct SurfacePoint {
    glm::vec3 position;
    glm::vec3 geometric_normal; ///< unit, of the face side
    Frame frame;                ///< shading: x = weft, y = warp, z = face
    glm::vec2 uv;
    const Surface* surface;
    uint32_t triangle;
    float distance;
};

enum class SamplerKind { independent, sobol };

/// Everything that decides a picture but its size in samples.
struct RenderSettings {
    int samples = 16;  ///< per pixel
    int max_depth = 5; ///< scattering events of a path, pbrt's maxdepth
    SamplerKind sampler = SamplerKind::sobol;
    uint64_t seed = 0;
    float filter_radius = 0.5f; ///< box filter, in pixels
    std::string output;         ///< the file that the scene names
};

/// A scene, constant after construction.
class Scene {
  public:
    Scene(std::vector<Surface> surfaces, std::vector<std::shared_ptr<Light>> lights, Camera camera,
          RenderSettings settings);

    std::optional<SurfacePoint> intersect(const kernel::Ray& ray) const;
    /// Share of light that passes from `from` along unit `direction` up to `distance`: 0 where
    /// something opaque stands between, the product of unscattered beams through cloths.
    Rgb transmittance(const glm::vec3& from, const glm::vec3& direction, float distance) const;

    const std::vector<Surface>& surfaces() const { return surfaces_; }
    const std::vector<std::shared_ptr<Light>>& lights() const { return lights_; }
    /// Picks a light by power; `probability` is that of the choice.
    struct LightChoice {
        const Light* light;
        float probability;
    };
    std::optional<LightChoice> choose_light(float u) const;
    float choice_probability(const Light& light) const;

    Camera camera;
    RenderSettings settings;

  private:
    std::vector<Surface> surfaces_;
    std::vector<std::shared_ptr<Light>> lights_;
    std::vector<float> light_cdf_;
    kernel::Scene kernel_;
};

/// An origin just off the surface, on the side of `direction`, such that the ray cannot meet the
/// same point again at any scale (error bound of the float arithmetic).
glm::vec3 offset_origin(const SurfacePoint& point, const glm::vec3& direction);

} // namespace rapport
