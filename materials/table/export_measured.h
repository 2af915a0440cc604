#pragma once

#include "materials/table/bsdf_table.h"
#include "materials/table/measured_fields.h"
#include "renderer/core/progress.h"

#include <filesystem>

namespace rapport {

/// What a `measured` file lacks of the table that it was made from: shares of the incident light
/// in the mean over the bands and over an evenly bright sky (∝ cosθ dω), and how well it tells what
/// it does not lack.
struct MeasuredLosses {
    double kept = 0;             ///< scattered back by the face
    double transmitted = 0;      ///< scattered through from the face
    double unscattered = 0;      ///< passed straight through
    double back_reflected = 0;   ///< scattered back by the back side
    double back_transmitted = 0; ///< scattered through from the back side
    /// RMS difference of f·cosθ (luminance) over its mean, both directions even over the hemisphere
    /// and incidence between that of the file.
    double resolution = 0;
    double largest_albedo_error = 0; ///< of the directions of incidence there, of their luminance
};

/// How a file tells colours. Mitsuba's RGB variants read files with `rgb` alone, its spectral ones
/// and pbrt-v4 those with `spectra`; none reads a file with both.
enum class MeasuredColours { rgb, spectra };

/// The reflection of the face of a full table as a `measured` file. As spectra, a value for the
/// centre of every band; the three bands of an RGB table become the dominant wavelengths of the
/// sRGB primaries, in shares that have the colour under an equal-energy light (negative ones cut).
///
/// The format asks for factors of a microfacet model, which a cloth has not: ndf = 1 and sigma =
/// 1/4 leave spectra(s) as the intensity itself, and `vndf` is the density of half vectors whose
/// mirrored directions have density ∝ intensity, so that the nodes stand where the light goes and
/// directions are sampled in proportion to it.
MeasuredFields measured_fields(const BsdfTable& table, const std::string& name,
                               MeasuredColours colours, const ProgressSignal& progress = {});

/// Writes it, and tells what was lost. FileError(`name`) if the table is partial or lacks a side.
MeasuredLosses export_measured(const BsdfTable& table, const std::string& name,
                               MeasuredColours colours, const std::filesystem::path& path,
                               const ProgressSignal& progress = {});

} // namespace rapport
