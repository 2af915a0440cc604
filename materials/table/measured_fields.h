#pragma once

#include "renderer/core/math.h"

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

namespace rapport {

/// Numbers on a grid over the unit square, as many slices of rows × columns as the field has.
struct MeasuredGrid {
    size_t rows = 0, columns = 0;
    std::vector<float> values;

    bool empty() const { return values.empty(); }
};

/// A reflectance in the adaptive parameterisation of Dupuy & Jakob 2018, as `measured` of Mitsuba 3
/// and pbrt-v4 read it. Directions are mapped to the unit square by x = √(2θ/π), y = (φ + π)/2π;
/// slices of `vndf` and `luminance` run over incidence [φ, θ], those of `rgb` and `spectra` over
/// [φ, θ, channel]. With s = the inverse of the warp by `vndf` at the half vector m,
///     f·cosθo = spectra(s)·ndf(m) / (4·sigma(ωi)) [1/sr],
/// and `luminance` is the density over s by which the directions are sampled.
struct MeasuredFields {
    std::string description;
    std::vector<float> theta, phi; ///< of incidence, radians, ascending
    MeasuredGrid ndf, sigma, vndf, luminance;
    MeasuredGrid rgb;               ///< linear sRGB; may be empty if `spectra` is not
    MeasuredGrid spectra;           ///< may be empty if `rgb` is not
    std::vector<float> wavelengths; ///< nm, ascending, of `spectra`
    bool jacobian = true;           ///< false: f·cosθo is spectra(s) alone

    /// At most two φ of incidence: the reflectance does not depend on φi, and the half vector's
    /// azimuth counts from it.
    bool isotropic() const { return phi.size() <= 2; }
    /// How many equal parts of the circle the φ of incidence stand for: 1 = [−π, π], 2 = [−π, 0]
    /// and the same turned by π, 4 = [−π, −π/2] and its images mirrored in x and y.
    int symmetry() const;
};

/// The unit vector's place on the square, y in [0, 1), and back.
glm::vec2 measured_place(const glm::vec3& direction);
glm::vec3 measured_direction(const glm::vec2& place);
/// Solid angle of the directions `light` = `eye` mirrored at the half vector `m` over the area of
/// the places of m [sr]; floored near the pole as the format demands.
float measured_jacobian(const glm::vec3& eye, const glm::vec3& m);

/// Whether the tensor file at `path` holds such a reflectance, and no table of ours.
bool is_measured_file(const std::filesystem::path& path);
/// Every field is checked; a damaged file is a FileError that names the field. Small negative
/// values of `rgb` and `spectra`, which measurements leave, become 0.
MeasuredFields read_measured(const std::filesystem::path& path);
void write_measured(const MeasuredFields& fields, const std::filesystem::path& path);

} // namespace rapport
