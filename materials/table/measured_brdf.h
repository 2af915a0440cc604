#pragma once

#include "materials/table/marginal_warp.h"
#include "materials/table/measured_fields.h"
#include "renderer/core/bands.h"

#include <span>
#include <vector>

namespace rapport {

/// Evaluates and samples a `measured` reflectance as Mitsuba 3 does: `eye` takes the incidence
/// slot. Directions are unit vectors in a local frame; eye.z > 0.
class MeasuredBrdf {
  public:
    explicit MeasuredBrdf(const MeasuredFields& fields);

    struct Value {
        Rgb value; ///< f·cosθ of the light
        float pdf; ///< of `sample` [1/sr]; integrates to 1 over the whole sphere
    };
    /// The file's warp also leads to directions below the horizon, where the value is 0.
    Value eval_and_pdf(const glm::vec3& eye, const glm::vec3& light) const;
    glm::vec3 sample(const glm::vec3& eye, const glm::vec2& u) const;
    /// ∫ of the value over the hemisphere, linear between the directions of incidence of the file.
    Rgb albedo(const glm::vec3& eye) const;

  private:
    /// What depends on the eye alone, turned or mirrored to where the file has data.
    struct Incidence {
        glm::vec3 eye;
        glm::vec2 mirror; ///< what x and y were multiplied by, ±1
        float turns;      ///< that the half vector's place is turned back by, if isotropic
        SliceBlend slices;
        float scale; ///< 1/4σ
    };
    Incidence incidence(const glm::vec3& eye) const;
    glm::vec3 half_vector(const Incidence& from, glm::vec2 place) const;
    Rgb colour(const SliceBlend& slices, const glm::vec2& s) const;
    Rgb albedo_at(float theta, float phi) const;

    std::vector<float> theta_, phi_;
    bool isotropic_;
    int symmetry_;
    MeasuredGrid ndf_, sigma_;
    MarginalWarp vndf_, luminance_;
    size_t side_;              ///< rows and columns of `colours_`
    std::vector<Rgb> colours_; ///< [φ, θ, rows, columns]
    std::vector<Rgb> albedo_;  ///< [φ, θ]
};

} // namespace rapport
