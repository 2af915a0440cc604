#include "vgsp/path_tally.h"

#include <limits>
#include <numeric>

namespace rapport {

GoniophotometerCounts& operator+=(GoniophotometerCounts& a, const GoniophotometerCounts& b) {
    a.paths += b.paths;
    a.events += b.events;
    a.overlaps += b.overlaps;
    a.capped += b.capped;
    a.lost += b.lost;
    return a;
}

PathBatch trace_batch(const IncidentPathTracer& paths, const BsdfTable& table, size_t direction,
                      uint64_t seed, uint64_t first, uint64_t count) {
    PathBatch batch;
    batch.bins.reserve(count);
    batch.weights.reserve(count * paths.bands);
    batch.unscattered.assign(paths.bands, 0.0);
    batch.capped.assign(paths.bands, 0.0);
    const IncidentDirection& incident = table.incident[direction];
    IncidentPath path;
    for (uint64_t k = first; k < first + count; ++k) {
        CounterRng rng(seed, Purpose::incident_path, direction, k);
        paths.trace(incident, rng, path);
        const FibreLight& light = path.light;
        batch.counts += {1, light.events, light.overlaps, path.fate == PathFate::capped,
                         path.fate == PathFate::capped &&
                             light.events < static_cast<uint32_t>(paths.max_events)};
        if (path.fate == PathFate::absorbed)
            continue;
        if (path.fate == PathFate::scattered) {
            const bool to_front = light.direction.z > 0;
            const bool transmitted = to_front != (incident.side == Side::front);
            batch.bins.push_back(static_cast<uint32_t>((transmitted ? table.exits.bins() : 0) +
                                                       table.exits.bin(light.direction)));
            for (size_t band = 0; band < paths.bands; ++band)
                batch.weights.push_back(static_cast<float>(path.weight(band)));
            continue;
        }
        auto& sums = path.fate == PathFate::capped ? batch.capped : batch.unscattered;
        for (size_t band = 0; band < paths.bands; ++band)
            sums[band] += path.weight(band);
    }
    return batch;
}

PathTally::PathTally(const BsdfTable& table) : bands_(table.bands.count()) {
    const size_t bins = table.exits.bins();
    solid_angle_.resize(2 * bins);
    for (size_t bin = 0; bin < 2 * bins; ++bin)
        solid_angle_[bin] = table.exits.solid_angle(bin % bins);
    sum_.assign(2 * bins * bands_, 0.0);
    sum_mean2_.assign(2 * bins, 0.0);
    unscattered_.assign(bands_, 0.0);
    capped_.assign(bands_, 0.0);
}

void PathTally::add(const PathBatch& batch) {
    const float* weight = batch.weights.data();
    for (const uint32_t bin : batch.bins) {
        double mean = 0;
        for (size_t band = 0; band < bands_; ++band, ++weight) {
            sum_[bin * bands_ + band] += *weight;
            mean += *weight;
        }
        const double mean2 = square(mean / bands_);
        sum_mean2_[bin] += mean2;
        sum_density2_ += square(mean2 / solid_angle_[bin]);
    }
    for (size_t band = 0; band < bands_; ++band) {
        unscattered_[band] += batch.unscattered[band];
        capped_[band] += batch.capped[band];
    }
    counts_ += batch.counts;
}

double PathTally::error_of_one_path() const {
    const double n = static_cast<double>(counts_.paths);
    double total = 0, variance = 0;
    for (size_t bin = 0; bin < solid_angle_.size(); ++bin) {
        const double* sums = &sum_[bin * bands_];
        const double mean = std::accumulate(sums, sums + bands_, 0.0) / (bands_ * n);
        total += mean;
        if (n > 1)
            variance += (sum_mean2_[bin] / n - mean * mean) * n / (n - 1) / solid_angle_[bin];
    }
    return total > 0 ? 4 * kPi * std::max(variance, 0.0) / square(total) : 0.0;
}

double PathTally::uncertainty() const {
    const double n = static_cast<double>(counts_.paths);
    const double total = std::accumulate(sum_.begin(), sum_.end(), 0.0) / (bands_ * n);
    if (!(total > 0))
        return std::numeric_limits<double>::infinity();
    // By the delta method. The number is (D − M)/total² with D = Σ_b E[w²]_b/Ω_b, a mean over the
    // paths, and M = Σ_b E[w]_b²/Ω_b, whose influence per path is 2·w·E[w]_b/Ω_b; the three are
    // taken as independent.
    double density = 0, peaks = 0, peaks2 = 0, mean2 = 0;
    for (size_t bin = 0; bin < solid_angle_.size(); ++bin) {
        const double* sums = &sum_[bin * bands_];
        const double mean = std::accumulate(sums, sums + bands_, 0.0) / (bands_ * n);
        const double square_mean = sum_mean2_[bin] / n;
        density += square_mean / solid_angle_[bin];
        peaks += mean * mean / solid_angle_[bin];
        peaks2 += square_mean * square(mean / solid_angle_[bin]);
        mean2 += square_mean;
    }
    const double of_density = std::max(sum_density2_ / n - square(density), 0.0);
    const double of_peaks = 4 * std::max(peaks2 - square(peaks), 0.0);
    const double of_total = 4 * std::max(mean2 / square(total) - 1, 0.0);
    return std::sqrt(((of_density + of_peaks) / square(density - peaks) + of_total) / n);
}

double PathTally::accuracy() const {
    return std::sqrt(error_of_one_path() / static_cast<double>(counts_.paths));
}

void PathTally::write(BsdfTable& table, size_t direction) const {
    const double n = static_cast<double>(counts_.paths);
    const size_t bins = table.exits.bins();
    std::vector<double> scattered(bands_, 0.0);
    for (size_t bin = 0; bin < 2 * bins; ++bin)
        for (size_t band = 0; band < bands_; ++band) {
            const double flux = sum_[bin * bands_ + band] / n;
            scattered[band] += flux;
            table.at(direction, bin < bins ? 0 : 1, bin % bins, band) =
                static_cast<float>(flux / solid_angle_[bin]);
        }
    for (size_t band = 0; band < bands_; ++band) {
        const size_t i = direction * bands_ + band;
        const double unscattered = unscattered_[band] / n, capped = capped_[band] / n;
        table.unscattered[i] = static_cast<float>(unscattered);
        table.capped[i] = static_cast<float>(capped);
        table.absorbed[i] =
            static_cast<float>(std::max(0.0, 1 - scattered[band] - unscattered - capped));
    }
    table.accuracy[direction] = static_cast<float>(accuracy());
    table.paths[direction] = counts_.paths;
}

} // namespace rapport
