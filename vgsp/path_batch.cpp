#include "vgsp/path_tally.h"

namespace rapport {

PathBatch trace_batch(const PathTracers& tracers, const BsdfTable& table, size_t direction,
                      size_t group, uint64_t seed, uint64_t first, uint64_t count,
                      const StopSignal& stopped) {
    const size_t channels = tracers.at(group, 0).channels;
    PathBatch batch;
    batch.group = group;
    batch.quarters.reserve(count);
    batch.weights.reserve(count * channels);
    batch.unscattered.assign(channels, 0.0);
    batch.capped.assign(channels, 0.0);
    batch.lost.assign(channels, 0.0);
    const IncidentDirection& incident = table.incident[direction];
    const ExitBins exits = table.exits_of(direction);
    const auto add = [&](const IncidentPath& path, const IncidentPathTracer& paths) {
        const FibreLight& light = path.light;
        const bool capped = path.fate == PathFate::capped;
        const bool lost = capped && light.events < static_cast<uint32_t>(paths.max_events);
        batch.counts += {1, light.events, light.overlaps, capped, lost};
        if (path.fate == PathFate::absorbed)
            return;
        if (path.fate == PathFate::scattered) {
            const bool to_front = light.direction.z > 0;
            const bool transmitted = to_front != (incident.side == Side::front);
            batch.quarters.push_back(static_cast<uint32_t>(
                (transmitted ? 4 * table.exits.bins() : 0) + exits.quarter(light.direction)));
            for (size_t channel = 0; channel < channels; ++channel)
                batch.weights.push_back(static_cast<float>(path.weight(channel)));
            return;
        }
        for (size_t channel = 0; channel < channels; ++channel) {
            const double weight = path.weight(channel);
            (capped ? batch.capped : batch.unscattered)[channel] += weight;
            if (lost)
                batch.lost[channel] += weight;
        }
    };
    IncidentPath path;
    uint64_t traced = 0;
    for (size_t realisation = 0; realisation < tracers.realisations; ++realisation) {
        const IncidentPathTracer& paths = tracers.at(group, realisation);
        const uint64_t until = count * (realisation + 1) / tracers.realisations;
        batch.paths.push_back(until - traced);
        const size_t deposits = batch.quarters.size();
        for (; traced < until; ++traced) {
            throw_if(stopped);
            CounterRng rng(seed, Purpose::incident_path, direction * tracers.groups + group,
                           first + traced);
            paths.trace(incident, rng, path);
            add(path, paths);
        }
        batch.deposits.push_back(batch.quarters.size() - deposits);
    }
    return batch;
}

} // namespace rapport
