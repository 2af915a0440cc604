#include "vgsp/incident_path.h"

#include <algorithm>

namespace rapport {
namespace {

/// Below this weight in its brightest channel a path plays for its life: it goes on at this weight
/// with a probability that leaves the mean as it is.
constexpr double kDim = 0.02;
constexpr double kDimDepth = 3.9; // a little under −ln kDim

/// Whether the path goes on.
bool survives(IncidentPath& path, std::span<const FibreMedium> media, CounterRng& rng) {
    optical_depths(path.light, media, path.optical_depth);
    const double least_depth = *std::ranges::min_element(path.optical_depth);
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

void IncidentPath::start(const glm::dvec3& position, const glm::dvec3& direction, size_t kinds,
                         size_t channels) {
    light.position = position;
    light.direction = direction;
    light.travelled = glm::dvec3(0);
    light.segment = kernel::FibreTracer::kNone;
    light.inside = light.scattered = false;
    light.events = light.overlaps = 0;
    light.surface_depth = 0;
    light.length.assign(kinds, 0.0);
    optical_depth.assign(channels, 0.0);
    boost = 1;
}

void IncidentPathTracer::trace(const IncidentDirection& incident, CounterRng& rng,
                               IncidentPath& path) const {
    const double x = rng.uniform(), y = rng.uniform();
    path.start({x * tracer.cell().x, y * tracer.cell().y,
                incident.side == Side::front ? tracer.z_max() : tracer.z_min()},
               -towards_light(incident), media.size(), channels);
    std::optional<PathFate> fate;
    while (!(fate = step(path, rng))) {
    }
    path.fate = *fate;
}

std::optional<PathFate> IncidentPathTracer::step(IncidentPath& path, CounterRng& rng) const {
    const std::optional<PathFate> fate = advance_path(path, rng);
    if (fate)
        optical_depths(path.light, media, path.optical_depth);
    return fate;
}

std::optional<PathFate> IncidentPathTracer::advance_path(IncidentPath& path,
                                                         CounterRng& rng) const {
    FibreLight& light = path.light;
    if (light.events >= static_cast<uint32_t>(max_events))
        return PathFate::capped;
    switch (advance(tracer, media, light, rng)) {
    case FibreStep::leaves:
        return light.scattered ? PathFate::scattered : PathFate::unscattered;
    case FibreStep::lost:
        return PathFate::capped;
    case FibreStep::event:
        break;
    }
    if (roulette && !survives(path, media, rng))
        return PathFate::absorbed;
    return std::nullopt;
}

} // namespace rapport
