#include "vgsp/incident_path.h"

#include <algorithm>

namespace rapport {
namespace {

/// Below this weight in its brightest band a path plays for its life: it goes on at this weight
/// with a probability that leaves the mean as it is.
constexpr double kDim = 0.02;
constexpr double kDimDepth = 3.9; // a little under −ln kDim

/// Whether the path goes on.
bool survives(IncidentPath& path, CounterRng& rng) {
    const auto& depth = path.light.optical_depth;
    const double least_depth = *std::min_element(depth.begin(), depth.end());
    if (least_depth < kDimDepth) // boost is never below 1
        return true;
    const double brightest = path.boost * std::exp(-least_depth);
    if (brightest >= kDim)
        return true;
    if (rng.uniform() * kDim >= brightest)
        return false;
    path.boost *= kDim / brightest;
    return true;
}

} // namespace

glm::dvec3 towards_light(const IncidentDirection& incident) {
    glm::dvec3 w = spherical_direction(incident.theta, incident.phi);
    if (incident.side == Side::back)
        w.z = -w.z;
    return w;
}

void IncidentPathTracer::trace(const IncidentDirection& incident, CounterRng& rng,
                               IncidentPath& path) const {
    FibreLight& light = path.light;
    const double x = rng.uniform(), y = rng.uniform();
    light.position = {x * tracer.cell().x, y * tracer.cell().y,
                      incident.side == Side::front ? tracer.z_max() : tracer.z_min()};
    light.direction = -towards_light(incident);
    light.segment = kernel::FibreTracer::kNone;
    light.inside = light.scattered = false;
    light.events = light.overlaps = 0;
    light.optical_depth.assign(bands, 0.0);
    path.boost = 1;
    path.fate = PathFate::capped;
    while (light.events < static_cast<uint32_t>(max_events)) {
        switch (advance(tracer, media, light, rng)) {
        case FibreStep::leaves:
            path.fate = light.scattered ? PathFate::scattered : PathFate::unscattered;
            return;
        case FibreStep::lost:
            return;
        case FibreStep::event:
            break;
        }
        if (roulette && !survives(path, rng)) {
            path.fate = PathFate::absorbed;
            return;
        }
    }
}

} // namespace rapport
