#pragma once

#include "materials/table/bsdf_table.h"
#include "renderer/core/progress.h"

#include <filesystem>
#include <string>

namespace rapport {

/// How far the hemispherical sums of a Radiance file are from the table's.
struct RadianceLosses {
    size_t values = 0;             ///< numbers written
    double largest_flux_error = 0; ///< |sum − (R + T + unscattered)| of luminance, worst incidence
};

/// Writes a full table as Radiance BSDF XML: a TensorTree4 in the LBNL/Shirley-Chiu basis for each
/// of the four blocks, of CIE Y ("Visible") and u′, v′ against an equal-energy white. f [1/sr] is
/// the mean over cells of equal projected solid angle, π/32² sr; as in WINDOW, "back" is the side
/// of +z, our face. The unscattered beam lies in the cell that it leaves through, where Radiance
/// looks for it. Values are scaled (by under a percent, as a rule) so that every direction of
/// incidence scatters what the table says; then cells that are nearly equal are merged.
/// FileError(`name`) if the table is partial or lacks a side.
RadianceLosses export_radiance(const BsdfTable& table, const std::string& name,
                               const std::filesystem::path& path,
                               const ProgressSignal& progress = {});

} // namespace rapport
