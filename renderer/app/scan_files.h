#pragma once

#include "vgsp/plane_scan.h"

#include <filesystem>

namespace rapport {

/// One line per side, plane, θ of incidence, side of exit and angle (PlaneScan), in degrees: the
/// intensity in the mean over the bands and its standard error, then both for each band.
std::string scan_csv(std::span<const PlaneScan> scans);

/// Luminous intensity (the mean over the bands) over the angle, as in the paper's charts: a row of
/// two diagrams, reflection and transmission, for each side and plane, a curve for each θ, banded
/// by its standard error, a dotted line where a mirror, or no cloth, would send the light.
std::string scan_svg(std::span<const PlaneScan> scans);

} // namespace rapport
