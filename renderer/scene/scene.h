#pragma once

#include "materials/bsdf.h"
#include "renderer/kernel/scene.h"
#include "renderer/scene/camera.h"
#include "renderer/scene/light/area_light.h"
#include "renderer/scene/light/light.h"
#include "renderer/scene/mesh/mesh.h"
#include "renderer/scene/picture.h"
#include "renderer/scene/render_settings.h"
#include "renderer/scene/scene_description.h"
#include "renderer/scene/shape/placed_fibres.h"

#include <memory>
#include <optional>
#include <unordered_map>
#include <vector>

namespace rapport {

/// What lies on a surface from place to place, whatever its material.
struct Print {
    std::shared_ptr<const PictureTexture> picture; ///< multiplies what is scattered, if any
    bool vertex_colors = false;                    ///< as do the mesh's, if so
    std::optional<Opacity> opacity = std::nullopt; ///< or all of the surface is there
};

/// One mesh with its material and, if it shines, its emission.
struct Surface {
    std::shared_ptr<const TriangleMesh> mesh; ///< its triangles and normals agree on the face side
    std::shared_ptr<const Bsdf> material;
    /// What the material was made from, under the name that the surface's own file gives it; for
    /// those who dress the surface anew. May be absent.
    std::shared_ptr<const MaterialDescription> description;
    Print print{};
    Rgb emission{0};                             ///< radiance of the face side
    bool two_sided_emission = false;             ///< of the other side too
    std::shared_ptr<const AreaLight> area_light; ///< set by Scene's constructor where it shines
    /// Its triangles are as small as its makers were told that they are seen (Sight).
    bool cut_by_sight = false;
    /// What the mesh is only the box of; the material then tells of nothing but the albedo.
    std::optional<PlacedFibres> fibres = std::nullopt;
};

/// What a ray met, ready for shading.
struct SurfacePoint {
    glm::vec3 position;
    glm::vec3 geometric_normal; ///< unit, of the face side
    /// Shading: z = face side, y = warp (∂P/∂v made orthonormal to z), x = weft = y × z: where the
    /// cloth is sheared, its table keeps the warp's direction, the nearest of the orthogonal rules
    /// to a sheared cloth measured anew (tests/bench/charts/shear.svg). Where the UVs do not tell,
    /// any frame about z.
    Frame frame;
    const Surface* surface;
    uint32_t triangle;
    glm::vec2 barycentric; ///< weights of its 2nd and 3rd vertex
    float distance;        ///< along the ray, whose direction is of unit length
    float reach;           ///< largest coordinate of the triangle: the scale of the rounding errors
    float opacity;         ///< how much of the surface is there: 1 but for its print

    /// The shading frame, or, where the eye sees by the geometry one side and by the shading normal
    /// the other, as on silhouettes, the frame of the geometric normal.
    Frame frame_towards(const glm::vec3& eye) const;
    Rgb reflectance() const; ///< what the surface's print multiplies scattered light by
};

/// A scene, constant after construction.
class Scene {
  public:
    Scene(std::vector<Surface> surfaces, std::vector<std::shared_ptr<Light>> lights, Camera camera,
          RenderSettings settings);
    /// The same meshes in other materials and emissions and under other lights, which have been
    /// prepared; nothing is built anew that depends on the meshes alone.
    Scene(const Scene& scene, std::vector<Surface> surfaces,
          std::vector<std::shared_ptr<Light>> lights);

    /// What a ray meets, holes in a surface (of opacity 0) left out.
    std::optional<SurfacePoint> intersect(const kernel::Ray& ray) const;
    /// The same of rays that lie close together; at most a packet of them.
    kernel::Packet<std::optional<SurfacePoint>> intersect(std::span<const kernel::Ray> rays) const;
    /// Share of the light of `light` that passes from there to `from`, `distance` along unit
    /// `direction`: 0 where something opaque stands between, the product of unscattered beams
    /// through cloths; through explicit fibres 1 where the ray meets none. After `kMaxLayers`
    /// cloths it is 0. The light's own surface is no obstacle over the last 1/10,000 of the way:
    /// each cloth sets the ray off along its normal, and so the end, where it is oblique.
    Rgb transmittance(const glm::vec3& from, const glm::vec3& direction, float distance,
                      const Light& light) const;
    static constexpr int kMaxLayers = 1000;

    const std::vector<Surface>& surfaces() const { return surfaces_; }
    /// The lights that are no surface.
    const std::vector<std::shared_ptr<Light>>& lights() const { return lights_; }

    /// Picks a light, half of the times by power and half uniformly: a sky over a wide scene has so
    /// much power that the lamp beside a garment would hardly ever be chosen by it. `probability`
    /// is that of the choice. Nothing if no light is sampled.
    struct LightChoice {
        const Light* light;
        float probability;
    };
    std::optional<LightChoice> choose_light(float u) const;
    float choice_probability(const Light& light) const;
    /// The lights that are no surface, for rays that leave the scene.
    const std::vector<LightChoice>& distant_lights() const { return distant_lights_; }

    Camera camera;
    RenderSettings settings;

  private:
    void light_up();
    SurfacePoint surface_point(const kernel::Hit& hit) const;
    std::optional<SurfacePoint> past_holes(const kernel::Ray& ray,
                                           const std::optional<kernel::Hit>& hit) const;
    Frame shading_frame(const Surface& surface, const kernel::Hit& hit) const;

    std::vector<Surface> surfaces_;
    std::vector<std::shared_ptr<Light>> lights_; ///< those that are no surface
    std::vector<LightChoice> choices_;           ///< all lights of positive power
    std::vector<LightChoice> distant_lights_;
    std::unordered_map<const Light*, float> probability_;
    std::shared_ptr<const kernel::Scene> kernel_;
};

/// By magnitude: what rounding errors of a place are in proportion to.
float largest_coordinate(const glm::vec3& place);

/// An origin just off the surface, on the side of `direction`, such that the ray cannot meet the
/// same triangle again at any scale: along the geometric normal by 16 ε of the triangle's largest
/// coordinate (ε = 2⁻²³), twice what rays leaving random triangles at scales of 10⁻⁴ to 10⁴ were
/// seen to need for the rounding of `position` (barycentric) and of the kernel's own test. Cf.
/// Wächter & Binder 2019, "A Fast and Robust Method for Avoiding Self-Intersection", who offset by
/// up to 256 units in the last place of each coordinate.
glm::vec3 offset_origin(const SurfacePoint& point, const glm::vec3& direction);
/// The same for what left the box of fibres that it had met in `entry`.
glm::vec3 offset_origin(const SurfacePoint& entry, const PlacedFibres::Passage& passage);

} // namespace rapport
