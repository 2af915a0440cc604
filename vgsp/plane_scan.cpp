#include "vgsp/plane_scan.h"

#include "renderer/core/parallel.h"
#include "vgsp/path_tally.h"

#include <algorithm>
#include <chrono>
#include <numeric>
#include <optional>
#include <stdexcept>

namespace rapport {
namespace {

constexpr int kBins = 2 * PlaneScan::kAngles;
constexpr uint64_t kBatchPaths = 2048;
constexpr uint64_t kChunkPaths = 64 * kBatchPaths; ///< between two looks at the clock
constexpr uint64_t kPilotPaths = 1 << 16;          ///< and as many again …
constexpr uint64_t kMostPilotPaths = 1 << 18;      ///< … up to this, …
constexpr double kPilotHits = 2000;                ///< … until the detector has seen so many
constexpr uint64_t kMostPaths = uint64_t{1} << 40;
constexpr uint64_t kFirstPilotPath = kMostPaths; ///< the pilot's numbers come after all others

/// Sums over the paths that the detector sees.
struct Tally {
    Tally(size_t bands, size_t groups, size_t realisations)
        : bands(bands), groups(groups), sum(kBins * bands), sum2(kBins * bands), mean(kBins),
          mean2(kBins), realisation(kBins * realisations), realisation_paths(realisations) {}

    /// `weights` are those of the bands of a group.
    void deposit(size_t bin, size_t group, size_t from, std::span<const double> weights) {
        const size_t first = bin * bands + group * weights.size();
        double total = 0;
        for (size_t band = 0; band < weights.size(); ++band) {
            sum[first + band] += weights[band];
            sum2[first + band] += square(weights[band]);
            total += weights[band];
        }
        const double average = total / static_cast<double>(bands);
        mean[bin] += average;
        mean2[bin] += square(average);
        realisation[bin * realisation_paths.size() + from] += average;
    }
    Tally& operator+=(const Tally& other) {
        const auto add = [](std::vector<double>& to, const std::vector<double>& from) {
            std::ranges::transform(to, from, to.begin(), std::plus());
        };
        add(sum, other.sum);
        add(sum2, other.sum2);
        add(mean, other.mean);
        add(mean2, other.mean2);
        add(realisation, other.realisation);
        add(realisation_paths, other.realisation_paths);
        paths += other.paths;
        return *this;
    }
    /// Of one path's weight in a bin, in the mean over the bands. Groups of bands are traced apart,
    /// so that their variances add.
    double variance(size_t bin) const {
        const double n = static_cast<double>(paths);
        double squared_means = 0;
        for (size_t group = 0; group < groups; ++group) {
            const double* first = &sum[bin * bands + group * (bands / groups)];
            const double total = std::accumulate(first, first + bands / groups, 0.0);
            squared_means += square(total / static_cast<double>(bands) / n);
        }
        return std::max(0.0, mean2[bin] / n - squared_means);
    }
    /// ε²·N: what ε² would be after one path.
    double error_of_one_path() const {
        const double n = static_cast<double>(paths);
        double total = 0, sum_of_variances = 0;
        for (int bin = 0; bin < kBins; ++bin) {
            total += mean[bin] / n;
            sum_of_variances += variance(bin) * n / (n - 1);
        }
        return total > 0 ? kBins * sum_of_variances / square(total) : 0.0;
    }
    /// How many paths of equal weight would tell as much as those seen (Kish's effective size).
    double hits() const {
        const double total = std::accumulate(mean.begin(), mean.end(), 0.0);
        return total > 0 ? square(total) / std::accumulate(mean2.begin(), mean2.end(), 0.0) : 0;
    }
    /// As PathTally::realisation_error(), of windows of equal solid angles.
    std::optional<double> realisation_error() const {
        const size_t r = realisation_paths.size();
        if (r < 2)
            return std::nullopt;
        const double total = std::accumulate(mean.begin(), mean.end(), 0.0);
        if (paths < 2 * r || total == 0)
            return 0;
        double spread = 0;
        for (size_t bin = 0; bin < kBins; ++bin)
            spread += variance_between(std::span(realisation).subspan(bin * r, r), mean2[bin],
                                       realisation_paths);
        return std::sqrt(kBins * std::max(spread, 0.0) / static_cast<double>(r)) *
               static_cast<double>(paths) / total;
    }
    double accuracy() const { return std::sqrt(error_of_one_path() / static_cast<double>(paths)); }

    size_t bands, groups;                  ///< of bands that share paths
    std::vector<double> sum, sum2;         ///< [bin, band], of weights and their squares
    std::vector<double> mean, mean2;       ///< [bin], of the weights' means over the bands
    std::vector<double> realisation;       ///< [bin, realisation], of the same means
    std::vector<double> realisation_paths; ///< in each group
    uint64_t paths = 0;                    ///< of all realisations, in each group
};

uint64_t most_paths(const GoniophotometerSettings& settings) {
    return settings.max_paths > 0 ? settings.max_paths : kMostPaths;
}

/// In whole batches, going by those of a tally that has seen light.
uint64_t paths_needed(const Tally& tally, const GoniophotometerSettings& settings) {
    const double batches = tally.error_of_one_path() / square(settings.accuracy) / kBatchPaths;
    const double most = static_cast<double>(kMostPaths / kBatchPaths);
    return std::min(most_paths(settings),
                    static_cast<uint64_t>(std::min(std::floor(batches) + 1, most)) * kBatchPaths);
}

/// The bin that sees light travelling along `direction`, if any does.
std::optional<size_t> seen_in(const glm::dvec3& direction, const IncidentDirection& incident) {
    const double c = std::cos(incident.phi), s = std::sin(incident.phi);
    static const double limit = std::sin(PlaneScan::kHalfWidth);
    if (std::abs(direction.y * c - direction.x * s) > limit)
        return std::nullopt;
    const double angle = std::atan2(direction.x * c + direction.y * s, std::abs(direction.z));
    const double bin = std::floor(angle / PlaneScan::kStep + 0.5 * PlaneScan::kAngles);
    if (bin < 0 || bin >= PlaneScan::kAngles)
        return std::nullopt;
    const bool reflected = (direction.z > 0) == (incident.side == Side::front);
    return (reflected ? 0 : PlaneScan::kAngles) + static_cast<size_t>(bin);
}

/// Traces one direction's paths.
class Detector {
  public:
    Detector(const PathTracers& tracers, const IncidentDirection& incident, size_t number,
             uint64_t seed)
        : tracers_(tracers), incident_(incident), number_(number), seed_(seed) {}

    Tally empty_tally() const {
        return {tracers_.groups * tracers_.tracers[0].channels, tracers_.groups,
                tracers_.realisations};
    }

    void trace(uint64_t first, uint64_t count, Tally& tally) const {
        std::vector<Tally> batches((count + kBatchPaths - 1) / kBatchPaths, empty_tally());
        parallel_for(batches.size(), [&](size_t i) {
            const uint64_t from = i * kBatchPaths, to = std::min(count, from + kBatchPaths);
            trace_batch(first + from, first + to, batches[i]);
        });
        for (const Tally& batch : batches)
            tally += batch;
    }

    /// How many paths reach the accuracy asked for, going by those of a pilot.
    uint64_t plan(const GoniophotometerSettings& settings,
                  const std::function<bool()>& time_is_up) const {
        const uint64_t most = most_paths(settings);
        if (most <= kPilotPaths)
            return most;
        Tally pilot = empty_tally();
        while (pilot.paths < kMostPilotPaths && pilot.hits() < kPilotHits && !time_is_up())
            trace(kFirstPilotPath + pilot.paths, kPilotPaths, pilot);
        if (pilot.hits() == 0)
            return std::min(most, kMostPilotPaths);
        return paths_needed(pilot, settings);
    }

  private:
    void trace_batch(uint64_t first, uint64_t end, Tally& tally) const {
        tally.paths = end - first;
        uint64_t from = first;
        for (size_t realisation = 0; realisation < tracers_.realisations; ++realisation) {
            const uint64_t to = first + tally.paths * (realisation + 1) / tracers_.realisations;
            for (size_t group = 0; group < tracers_.groups; ++group)
                trace_group(group, realisation, from, to, tally);
            tally.realisation_paths[realisation] = static_cast<double>(to - from);
            from = to;
        }
    }

    void trace_group(size_t group, size_t realisation, uint64_t first, uint64_t end,
                     Tally& tally) const {
        const IncidentPathTracer& tracer = tracers_.at(group, realisation);
        IncidentPath path;
        std::vector<double> weights(tracer.channels);
        for (uint64_t k = first; k < end; ++k) {
            CounterRng rng(seed_, Purpose::incident_path, number_ * tracers_.groups + group, k);
            tracer.trace(incident_, rng, path);
            if (path.fate != PathFate::scattered)
                continue;
            if (const std::optional<size_t> bin = seen_in(path.light.direction, incident_)) {
                for (size_t band = 0; band < weights.size(); ++band)
                    weights[band] = path.weight(band);
                tally.deposit(*bin, group, realisation, weights);
            }
        }
    }

    const PathTracers& tracers_;
    const IncidentDirection& incident_;
    size_t number_;
    uint64_t seed_;
};

PlaneScan result_of(const Tally& tally, const IncidentDirection& incident, const Bands& bands) {
    const double n = static_cast<double>(tally.paths), solid_angle = PlaneScan::solid_angle();
    const auto intensity = [&](const std::vector<double>& sum) {
        std::vector<double> result(sum.size());
        std::ranges::transform(sum, result.begin(),
                               [&](double value) { return value / n / solid_angle; });
        return result;
    };
    const auto error = [&](const std::vector<double>& sum, const std::vector<double>& sum2) {
        std::vector<double> result(sum.size());
        std::ranges::transform(sum, sum2, result.begin(), [&](double total, double squares) {
            return std::sqrt(std::max(0.0, squares / n - square(total / n)) / n) / solid_angle;
        });
        return result;
    };
    std::vector<double> mean_error;
    for (size_t bin = 0; bin < kBins; ++bin)
        mean_error.push_back(std::sqrt(tally.variance(bin) / n) / solid_angle);
    return {incident,
            bands,
            intensity(tally.sum),
            error(tally.sum, tally.sum2),
            intensity(tally.mean),
            mean_error,
            tally.accuracy(),
            tally.realisation_error(),
            tally.paths};
}

} // namespace

double PlaneScan::solid_angle() { return kStep * 2 * std::sin(kHalfWidth); }

std::vector<PlaneScan>
scan_planes(std::span<const kernel::FibreTracer> realisations, std::span<const FibreOptics> optics,
            const Bands& bands, std::span<const IncidentDirection> incident,
            const GoniophotometerSettings& settings,
            const std::function<void(const GoniophotometerProgress&)>& progress) {
    if (!(settings.accuracy > 0))
        throw std::invalid_argument("the accuracy asked for is not positive");
    if (settings.max_events < 1)
        throw std::invalid_argument("a path is allowed no events");
    if (realisations.empty() || realisations.size() > kBatchPaths)
        throw std::invalid_argument("no realisation of the cloth, or too many");
    const std::vector<std::vector<FibreMedium>> groups =
        media_of_groups(optics, bands.count(), realisations[0]);
    PathTracers tracers{realisations.size(), groups.size(), {}};
    for (const std::vector<FibreMedium>& media : groups)
        for (const kernel::FibreTracer& tracer : realisations)
            tracers.tracers.push_back(
                {tracer, media, bands.count() / groups.size(), settings.max_events, true});

    const auto start = std::chrono::steady_clock::now();
    const auto seconds = [&] {
        return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    };
    const double directions = static_cast<double>(incident.size());
    std::vector<PlaneScan> scans;
    double worst = 0, traced = 0;
    for (size_t d = 0; d < incident.size(); ++d) {
        const Detector detector(tracers, incident[d], d, settings.seed);
        const double until = settings.max_seconds * (static_cast<double>(d) + 1) / directions;
        const auto time_is_up = [&] { return settings.max_seconds > 0 && seconds() >= until; };
        uint64_t planned = detector.plan(settings, time_is_up);
        Tally tally = detector.empty_tally();
        while (tally.paths < planned && (tally.paths == 0 || !time_is_up())) {
            const uint64_t count = std::min(kChunkPaths, planned - tally.paths);
            detector.trace(tally.paths, count, tally);
            traced += static_cast<double>(count);
            if (tally.paths == planned && tally.accuracy() > settings.accuracy)
                planned = std::max(planned, paths_needed(tally, settings));
            if (!progress)
                continue;
            const double share = static_cast<double>(tally.paths) / static_cast<double>(planned);
            const double fraction = (static_cast<double>(d) + share) / directions, now = seconds();
            double left = now * (1 - fraction) / fraction;
            if (settings.max_seconds > 0)
                left = std::clamp(settings.max_seconds - now, 0.0, left);
            progress({std::max(worst, tally.accuracy()), fraction, now, left, traced / now});
        }
        scans.push_back(result_of(tally, incident[d], bands));
        worst = std::max(worst, scans.back().accuracy);
    }
    return scans;
}

} // namespace rapport
