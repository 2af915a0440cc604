#pragma once

#include "materials/table/bsdf_table.h"
#include "vgsp/fibre_step.h"

#include <optional>

namespace rapport {

enum class PathFate : uint8_t {
    scattered,   ///< left the cloth in another direction
    unscattered, ///< left it in its own: it met no fibre, or only fibres of index 1
    absorbed,    ///< what little was left of it ended in the roulette
    capped,      ///< ran out of events, or was lost among the fibres
};

/// A path of light through the cloth, and its end.
struct IncidentPath {
    FibreLight light;
    PathFate fate = PathFate::absorbed;
    double boost = 1;                  ///< by surviving the roulette
    std::vector<double> optical_depth; ///< per channel (FibreMedium)

    /// Puts light of full weight at `position`, outside all fibres.
    void start(const glm::dvec3& position, const glm::dvec3& direction, size_t kinds,
               size_t channels);
    /// Share of the path's light in that channel that is left.
    double weight(size_t channel) const { return boost * std::exp(-optical_depth[channel]); }
};

/// Paths of parallel light that falls on an endless cloth; constant, callable from any thread.
struct IncidentPathTracer {
    const kernel::FibreTracer& tracer;
    std::span<const FibreMedium> media;
    size_t channels;
    int max_events;
    bool roulette; ///< end dim paths early, without bias

    /// Follows one path from a point uniform over the cell's area, on the bounding plane of the
    /// side it arrives on. `path` is overwritten.
    void trace(const IncidentDirection& incident, CounterRng& rng, IncidentPath& path) const;
    /// Takes a path that has started through one more event; nothing while it goes on, else its
    /// fate, with its optical depths brought up to date.
    std::optional<PathFate> step(IncidentPath& path, CounterRng& rng) const;

  private:
    std::optional<PathFate> advance_path(IncidentPath& path, CounterRng& rng) const;
};

/// Unit vector towards where the light comes from.
glm::dvec3 towards_light(const IncidentDirection& incident);

} // namespace rapport
