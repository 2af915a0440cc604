#include "vgsp/colour_solver.h"

#include "renderer/core/parallel.h"
#include "vgsp/incident_path.h"

#include <algorithm>
#include <numeric>

namespace rapport {
namespace {

constexpr size_t kBatchPaths = 256;
constexpr double kGreatestAbsorption = 1e4; ///< [1/µm]: ten thousand times what hides a fibre

/// Cosine-weighted, from the face side.
IncidentDirection diffuse_direction(CounterRng& rng) {
    const double sin_theta = std::sqrt(rng.uniform());
    return {Side::front, std::asin(sin_theta), 2 * kPi * rng.uniform()};
}

} // namespace

ColourSolver::ColourSolver(const kernel::FibreTracer& tracer, std::span<const FibreOptics> optics,
                           const GoniophotometerSettings& settings)
    : stopped_(settings.stopped) {
    std::vector<FibreOptics> undyed(optics.begin(), optics.end());
    for (FibreOptics& kind : undyed)
        kind.absorption_per_um.clear();
    const std::vector<FibreMedium> media = fibre_media(undyed, 0, tracer);
    const IncidentPathTracer tracing{tracer, media, 0, settings.max_events, false};
    const size_t paths = settings.colour_paths;
    std::vector<std::vector<WhitePath>> batches((paths + kBatchPaths - 1) / kBatchPaths);
    parallel_for(batches.size(), [&](size_t batch) {
        IncidentPath path;
        const size_t end = std::min(paths, (batch + 1) * kBatchPaths);
        for (size_t k = batch * kBatchPaths; k < end; ++k) {
            throw_if(stopped_);
            CounterRng rng(settings.seed, Purpose::colour_solve, 0, k);
            const IncidentDirection incident = diffuse_direction(rng);
            tracing.trace(incident, rng, path);
            if (path.fate != PathFate::scattered)
                continue;
            const std::vector<double>& length = path.light.length;
            batches[batch].push_back({std::accumulate(length.begin(), length.end(), 0.0),
                                      std::exp(-path.light.surface_depth)});
        }
    });
    for (const std::vector<WhitePath>& batch : batches)
        paths_.insert(paths_.end(), batch.begin(), batch.end());
}

double ColourSolver::albedo(double absorption_per_um) const {
    double sum = 0;
    for (const WhitePath& path : paths_)
        sum += path.weight * std::exp(-absorption_per_um * path.length);
    return paths_.empty() ? 1.0 : sum / static_cast<double>(paths_.size());
}

double ColourSolver::least_albedo() const { return albedo(kGreatestAbsorption); }

std::optional<double> ColourSolver::absorption_for(double wanted) const {
    if (!(wanted <= greatest_albedo() && wanted >= least_albedo()))
        return std::nullopt;
    if (wanted == greatest_albedo())
        return 0.0;
    // The albedo falls steadily; bisection in the logarithm after a bracket is found.
    double low = 1e-9, high = kGreatestAbsorption;
    for (int step = 0; step < 60; ++step) {
        throw_if(stopped_);
        const double middle = std::sqrt(low * high);
        (albedo(middle) > wanted ? low : high) = middle;
    }
    return std::sqrt(low * high);
}

} // namespace rapport
