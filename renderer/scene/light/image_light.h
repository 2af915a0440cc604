#pragma once

#include "renderer/core/distribution.h"
#include "renderer/core/image.h"
#include "renderer/scene/light/light.h"

namespace rapport {

/// Light from all around by an image of radiance, +z up, looked up bilinearly and sampled where its
/// luminance is above the mean, by how much it is; what is below is for BSDF samples to find. A
/// square image is pbrt's equal-area octahedral map. An image twice as wide as high is a
/// latitude–longitude map: the zenith is its top row, its middle column looks along +x, and what
/// stands to the right in the image stands to the right as seen from inside.
class ImageLight final : public Light {
  public:
    /// "string filename" and "float scale". FileError if the file is no such image, a pixel is
    /// not finite, or the transformation is more than a rotation, reflection and
    /// uniform scale. Negative pixels, which lossy compression leaves around bright ones,
    /// become black, and are counted in a warning.
    explicit ImageLight(const LightContext& context);

    void prepare(const glm::vec3& scene_centre, float scene_radius) override;
    std::optional<LightSample> sample(const glm::vec3& from, const glm::vec2& u) const override;
    EscapedLight escaped(const glm::vec3& direction) const override;
    float power() const override; ///< of what is above the mean, for which it is sampled

  private:
    // The map between directions in the light's own space and the image, [0, 1]² from its top left.
    glm::dvec2 to_image(const glm::vec3& direction) const;
    glm::vec3 from_image(const glm::dvec2& position) const;
    /// Solid angle per unit area of the image where that shows a unit direction [sr]; 0 at a pole
    /// of the latitude–longitude map.
    float solid_angle(const glm::vec3& direction) const;

    void read_pixels(const LightContext& context, const std::filesystem::path& file);
    double mean_luminance(int x, int y) const;
    void prepare_sampling();
    Rgb pixel(int x, int y) const; ///< at most one step outside the image
    Rgb lookup(const glm::dvec2& position) const;

    int width_ = 0, height_ = 0;
    bool octahedral_ = false;
    std::vector<Rgb> pixels_;
    std::optional<Distribution2D> distribution_;
    glm::mat3 to_world_, from_world_;
    float scene_radius_ = 1;
};

} // namespace rapport
