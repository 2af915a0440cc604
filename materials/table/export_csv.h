#pragma once

#include "materials/table/bsdf_table.h"

#include <filesystem>

namespace rapport {

/// Writes every stored intensity as one line
///     side,theta_i,phi_i,theta_o,phi_o,solid_angle,band,intensity
/// `side` (front, back) is the one the light arrives on, and both θ count from its normal, so that
/// light which has passed the cloth has theta_o > 90; φ from +x (weft) towards +y (warp). Degrees;
/// solid angle [sr] and intensity [1/sr] of the bin with the centre (theta_o, phi_o); band by name.
/// The file appears whole or not at all.
void export_csv(const BsdfTable& table, const std::filesystem::path& path);

} // namespace rapport
