#pragma once

#include "materials/table/bsdf_table.h"
#include "renderer/core/checkpoint.h"
#include "renderer/core/stop_signal.h"
#include "renderer/kernel/fibre_tracer.h"
#include "vgsp/fibre_step.h"

#include <functional>
#include <span>

namespace rapport {

struct GoniophotometerSettings {
    double accuracy = 0.2;  ///< the ε asked for (design: RMS error over the mean, per direction)
    uint64_t max_paths = 0; ///< per incident direction (and band, if traced apart); 0 = no bound
    double max_seconds = 0; ///< for the whole run; 0 = no bound
    int max_events = 4096;  ///< boundary events of a path before it counts as capped
    uint64_t seed = 0;
    /// By which wanted colours are solved for: the standard error of an albedo is 0.5/√this at
    /// most.
    uint64_t colour_paths = 1 << 16;
    StopSignal stopped = nullptr; ///< asked before each path
};

/// Told after each increment of the run, and of the pilot that plans it.
struct GoniophotometerProgress {
    double accuracy; ///< largest ε over all directions so far; in the pilot infinite
    double fraction; ///< of the expected work, [0, 1]; in the pilot 0, for that is not yet known
    double seconds, seconds_left;
    double paths_per_second;
    bool pilot = false;
};

/// Where the paths of one run went, over all incident directions; the pilot's are not in it.
struct GoniophotometerCounts {
    uint64_t paths = 0, events = 0, overlaps = 0;
    uint64_t capped = 0; ///< out of events
    uint64_t lost = 0;   ///< of these, lost among the fibres (FibreTracer::Flight::lost)
    /// By which of its bounds the run ended before all that was planned: the checkpoint is worth
    /// going on from.
    bool out_of_time = false, out_of_paths = false;
};

/// Measures the scattering of any periodic assembly of fibres for the incident directions and
/// exit mesh already laid out in `table` (its arrays are filled). Several assemblies are
/// realisations of one random cloth: they share the paths of every direction equally, and the
/// spread between them is reported apart from the noise. `optics` is indexed by FibreChain::kind;
/// where a refractive index differs between the bands, each band has paths of its own. Path k of
/// direction d depends on (seed, d, k) alone, so the result does not depend on the threads. Light
/// of every path is accounted for as reflected, transmitted, unscattered, absorbed or capped.
///
/// The dyes of `colourways` share the paths with those of `optics`, each path being weighed in all
/// of them at its end. The accuracy asked for is then reached in all, and the one that progress
/// tells is the largest.
///
/// How many paths a direction gets is planned before they are traced, by a pilot whose own paths
/// are thrown away: to stop whenever the estimate looks good would make it look better than it is.
/// Where the paths planned turn out to leave ε above what was asked, as many more are added as they
/// themselves call for, until none is above. Here the statistics do decide the stop, against the
/// rule of the pilot; over hundreds of seeds the claimed ε was 1.000 to 1.001 ± 0.006 of the true
/// error, so that no bias is to be seen (tests/statistical/goniophotometer_error_test.cpp). Only
/// `max_seconds` makes the result depend on the machine: half of it may go to the pilot, and the
/// first increment (at least one batch of each direction) is made even if the time is up. What was
/// planned can be gone on with.
///
/// The pilot is the checkpoint's first increment. A checkpoint knows the run that it belongs to by
/// `table.metadata`, which must tell all that decides the result, and the incident directions:
/// FileError for one of another run. A run with another bound on its paths ("max_paths" in the
/// metadata) is the same run: it goes on to more of what was planned.
///
/// Throws std::invalid_argument for optics or settings outside their domain, and Stopped when told
/// to stop.
GoniophotometerCounts
measure(std::span<const kernel::FibreTracer> realisations, std::span<const FibreOptics> optics,
        const GoniophotometerSettings& settings, BsdfTable& table,
        const std::function<void(const GoniophotometerProgress&)>& progress = {},
        const Checkpoint& checkpoint = {}, const Colourways& colourways = {});

/// The same for an assembly that is not random.
inline GoniophotometerCounts
measure(const kernel::FibreTracer& tracer, std::span<const FibreOptics> optics,
        const GoniophotometerSettings& settings, BsdfTable& table,
        const std::function<void(const GoniophotometerProgress&)>& progress = {},
        const Checkpoint& checkpoint = {}, const Colourways& colourways = {}) {
    return measure(std::span(&tracer, 1), optics, settings, table, progress, checkpoint,
                   colourways);
}

} // namespace rapport
