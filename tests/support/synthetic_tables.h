#pragma once

#include "materials/table/bsdf_table.h"

#include <functional>

namespace rapport::tests {

/// Intensity [1/sr] of a made-up cloth in `band`, leaving along `out` (local frame of the cloth).
using Intensity =
    std::function<double(const IncidentDirection& from, const glm::dvec3& out, size_t band)>;

/// Fills every direction of a laid-out table with bin means of `intensity`. A share `unscattered`
/// passes straight through, and what is left of the light is absorbed.
void fill_table(BsdfTable& table, const Intensity& intensity, double unscattered = 0);

/// The grid that cloths are measured on, filled.
BsdfTable synthetic_table(const Intensity& intensity, double unscattered = 0);
/// A table of few directions and bins, whose file is a few kilobytes.
BsdfTable small_synthetic_table(const Intensity& intensity, double unscattered = 0,
                                const Bands& bands = {});

/// A smooth made-up satin: an anisotropic highlight about the mirror direction (narrow across the
/// warp, white), a coloured diffuse part, and forward transmission. Back and front differ. Not
/// reciprocal: it darkens with the cosine of incidence only.
double satin_intensity(const IncidentDirection& from, const glm::dvec3& out, size_t band);
/// Streaks of different slant in the four blocks, without mirror symmetry.
double slanted_intensity(const IncidentDirection& from, const glm::dvec3& out, size_t band);

} // namespace rapport::tests
