#pragma once

#include "materials/table/bsdf_table.h"
#include "vgsp/cloth.h"
#include "vgsp/goniophotometer.h"
#include "vgsp/micro_element.h"

#include <functional>

namespace rapport {

struct MeasureOptions {
    GoniophotometerSettings goniophotometer;
    /// (side, θ, φ) in radians; empty = the whole grid of the sides asked for.
    std::vector<IncidentDirection> incidence;
    bool front = true, back = true;
};

struct ClothMeasurement {
    BsdfTable table;
    MicroElement element;
    GoniophotometerCounts counts;
};

/// cloth → micro-element → (colours solved for absorption) → table, with everything that decides
/// the result in its metadata. One seed serves the fibres' dither, the colours and the paths.
/// FileError (at the cloth's path) for a cloth that cannot exist, or a colour out of reach.
ClothMeasurement
measure_cloth(const Cloth& cloth, const MeasureOptions& options,
              const std::function<void(const GoniophotometerProgress&)>& progress = {});

} // namespace rapport
