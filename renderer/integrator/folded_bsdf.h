#pragma once

#include "materials/bsdf.h"

namespace rapport {

/// A material about a shading normal, on a surface that lies otherwise. Directions that are on one
/// side by the geometry and on the other by the shading frame would lead through the surface: such
/// light is neither let through nor dropped, but mirrored at the surface to where both agree. That
/// maps solid angle to equal solid angle, and no two of the wrong directions to one, so that what
/// is scattered towards the eye, and its share of all, stay the material's own.
///
/// All directions are in the shading frame; `eye` is where both agree.
class FoldedBsdf {
  public:
    /// `normal` is the geometric one of the face side, less than 90° from the shading normal.
    FoldedBsdf(const Bsdf& material, const glm::vec3& eye, const glm::vec3& normal)
        : material_(material), eye_(eye), normal_(normal) {}

    BsdfValue eval_and_pdf(const glm::vec3& light) const {
        if (!agrees(light))
            return {Rgb(0), 0};
        BsdfValue both = material_.eval_and_pdf(eye_, light);
        if (const glm::vec3 other = mirrored(light); !agrees(other)) {
            const auto [value, pdf] = material_.eval_and_pdf(eye_, other);
            both.value += value;
            both.pdf += pdf;
        }
        return both;
    }

    std::optional<BsdfSample> sample(float choice, const glm::vec2& u) const {
        const auto drawn = material_.sample(eye_, choice, u);
        if (!drawn)
            return std::nullopt;
        const glm::vec3 other = mirrored(drawn->light);
        const bool agreed = agrees(drawn->light);
        if (agreed && agrees(other))
            return drawn;
        if (!agreed && !agrees(other)) // along the surface
            return std::nullopt;
        const glm::vec3 light = agreed ? drawn->light : other;
        if (drawn->pdf == kMirror)
            return BsdfSample{light, drawn->weight, kMirror};
        // What was drawn has its own density, whatever rounding makes of its direction.
        const auto [value, pdf] = material_.eval_and_pdf(eye_, other);
        const float both = drawn->pdf + pdf;
        return BsdfSample{light, (drawn->weight * drawn->pdf + value) / both, both};
    }

  private:
    bool agrees(const glm::vec3& w) const { return w.z * glm::dot(w, normal_) > 0; }
    glm::vec3 mirrored(const glm::vec3& w) const { return w - 2 * glm::dot(w, normal_) * normal_; }

    const Bsdf& material_;
    const glm::vec3 eye_, normal_;
};

} // namespace rapport
