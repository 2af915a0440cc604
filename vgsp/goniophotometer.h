#pragma once

#include "materials/table/bsdf_table.h"
#include "renderer/kernel/fibre_tracer.h"

#include <functional>
#include <span>
#include <vector>

namespace rapport {

/// Optics of one kind of fibre (FibreChain::kind).
struct FibreOptics {
    double refractive_index = 1.5;
    std::vector<double> absorption_per_um; ///< per band
    double surface_absorption = 0;         ///< share lost at each boundary event
};

struct GoniophotometerSettings {
    double accuracy = 0.2;  ///< the ε asked for (design: RMS error over the mean, per direction)
    uint64_t max_paths = 0; ///< per incident direction; 0 = no bound
    double max_seconds = 0; ///< for the whole run; 0 = no bound
    int max_events = 4096;  ///< boundary events of a path before it counts as capped
    uint64_t seed = 0;
};

/// Told after each increment of the run.
struct GoniophotometerProgress {
    double accuracy; ///< largest ε over all directions so far
    double fraction; ///< of the expected work, [0, 1]
    double seconds, seconds_left;
    double paths_per_second;
};

/// Where the paths of one run went, over all incident directions.
struct GoniophotometerCounts {
    uint64_t paths = 0, events = 0, overlaps = 0, capped = 0;
};

/// Measures the scattering of any periodic assembly of fibres for the incident directions and
/// exit mesh already laid out in `table` (its intensity, unscattered, absorbed, capped, accuracy
/// and paths arrays are filled). `optics` is indexed by FibreChain::kind. Path k of direction d
/// depends on (seed, d, k) alone, so the result does not depend on the threads. Light of every
/// path is accounted for as reflected, transmitted, unscattered, absorbed or capped.
GoniophotometerCounts
measure(const kernel::FibreTracer& tracer, std::span<const FibreOptics> optics,
        const GoniophotometerSettings& settings, BsdfTable& table,
        const std::function<void(const GoniophotometerProgress&)>& progress = {});

} // namespace rapport
