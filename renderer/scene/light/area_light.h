#pragma once

#include "renderer/core/distribution.h"
#include "renderer/scene/light/light.h"
#include "renderer/scene/mesh/mesh.h"

namespace rapport {

/// A mesh that shines with equal radiance in all directions, from its face side or from both.
/// Points are chosen uniformly by area.
class AreaLight final : public Light {
  public:
    /// Triangles run counter-clockwise seen from the face side; those without area do not shine.
    AreaLight(const TriangleMesh& mesh, const Rgb& radiance, bool two_sided);

    std::optional<LightSample> sample(const glm::vec3& from, const glm::vec2& u) const override;
    float power() const override;
    bool has_place() const override { return true; }

    /// Radiance that leaves the surface along unit `direction` where its unit normal is `normal`.
    Rgb emitted(const glm::vec3& normal, const glm::vec3& direction) const;
    /// Density over solid angle with which `sample` picks the surface's point at `offset` from
    /// `from`, where its normal is `normal` [1/sr].
    float pdf(const glm::vec3& offset, const glm::vec3& normal) const;

  private:
    struct Triangle {
        glm::vec3 corner, edge1, edge2, normal;
    };
    std::vector<Triangle> triangles_;
    std::optional<Distribution1D> by_area_;
    float area_ = 0;
    Rgb radiance_;
    bool two_sided_;
};

} // namespace rapport
