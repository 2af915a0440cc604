#include "vgsp/goniophotometer.h"

#include "renderer/core/parallel.h"
#include "vgsp/path_tally.h"

#include <algorithm>
#include <chrono>
#include <numbers>
#include <stdexcept>

namespace rapport {
namespace {

constexpr uint64_t kBatchPaths = 1024;
constexpr uint64_t kPilotPaths = 1024; ///< per direction, and twice as many again while it pays, …
constexpr uint64_t kMostPilotPaths = 32768; ///< … up to this
constexpr double kPlannedSigmas = 3;
constexpr uint64_t kMostPaths = uint64_t{1} << 40;
constexpr uint64_t kFirstPilotPath = kMostPaths;   ///< the pilot's numbers come after all others
constexpr size_t kWaitingBytes = size_t{64} << 20; ///< of deposits that wait to be summed

struct Task {
    size_t direction;
    uint64_t first, count;
};

class Run {
  public:
    Run(const IncidentPathTracer& paths, const GoniophotometerSettings& settings, BsdfTable& table)
        : paths_(paths), settings_(settings), table_(table),
          waiting_batches_(std::max<size_t>(
              1, kWaitingBytes / (kBatchPaths * (1 + paths.bands) * sizeof(float)))) {}

    /// How many paths each direction gets.
    std::vector<uint64_t> plan() const;
    /// Traces them and fills the table.
    GoniophotometerCounts
    measure(const std::vector<uint64_t>& planned,
            const std::function<void(const GoniophotometerProgress&)>& progress);

  private:
    double seconds() const {
        return std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
    }
    bool time_is_up() const {
        return settings_.max_seconds > 0 && seconds() >= settings_.max_seconds;
    }
    /// Traces `tasks`, sorted by direction and then by path, and adds them to the tallies in that
    /// order.
    void trace(std::span<const Task> tasks, std::vector<PathTally>& tallies) const;
    GoniophotometerProgress state(const std::vector<PathTally>& tallies, double fraction,
                                  double tracing_since) const;

    const IncidentPathTracer& paths_;
    const GoniophotometerSettings& settings_;
    BsdfTable& table_;
    size_t waiting_batches_;
    std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

/// Whether twice the pilot costs fewer paths than it takes off the plan: the margin for the pilot's
/// uncertainty shrinks by √2.
bool larger_pilot_pays(const PathTally& pilot, double accuracy) {
    const double margin =
        kPlannedSigmas * pilot.uncertainty() * pilot.error_of_one_path() / square(accuracy);
    return static_cast<double>(pilot.counts().paths) < (1 - std::numbers::sqrt2 / 2) * margin;
}

std::vector<uint64_t> Run::plan() const {
    const uint64_t most = settings_.max_paths > 0 ? settings_.max_paths : kMostPaths;
    std::vector<uint64_t> planned(table_.directions(), most);
    if (most <= kPilotPaths)
        return planned;
    std::vector<PathTally> pilots(planned.size(), PathTally(table_));
    std::vector<Task> tasks;
    do {
        tasks.clear();
        for (size_t d = 0; d < pilots.size(); ++d) {
            const uint64_t done = pilots[d].counts().paths;
            const uint64_t until = std::max(kPilotPaths, 2 * done);
            if (done == 0 || (until <= std::min(kMostPilotPaths, most) &&
                              larger_pilot_pays(pilots[d], settings_.accuracy)))
                for (uint64_t k = done; k < until; k += kBatchPaths)
                    tasks.push_back({d, kFirstPilotPath + k, kBatchPaths});
        }
        trace(tasks, pilots);
    } while (!tasks.empty());
    for (size_t d = 0; d < pilots.size(); ++d) {
        const double needed = pilots[d].error_of_one_path() *
                              (1 + kPlannedSigmas * pilots[d].uncertainty()) /
                              square(settings_.accuracy);
        // Where nothing scatters there is no error to plan by (it is not a number), and paths are
        // short: as many as the pilot had tell what goes straight through.
        const uint64_t paths = std::isnan(needed)    ? kMostPilotPaths
                               : needed < kMostPaths ? static_cast<uint64_t>(std::ceil(needed))
                                                     : kMostPaths;
        planned[d] = std::min(most, std::max(paths, kBatchPaths));
    }
    return planned;
}

void Run::trace(std::span<const Task> tasks, std::vector<PathTally>& tallies) const {
    while (!tasks.empty()) {
        const std::span<const Task> chunk = tasks.first(std::min(tasks.size(), waiting_batches_));
        std::vector<PathBatch> found(chunk.size());
        parallel_for(chunk.size(), [&](size_t i) {
            found[i] = trace_batch(paths_, table_, chunk[i].direction, settings_.seed,
                                   chunk[i].first, chunk[i].count);
        });
        std::vector<size_t> first_of_direction;
        for (size_t i = 0; i < chunk.size(); ++i)
            if (i == 0 || chunk[i].direction != chunk[i - 1].direction)
                first_of_direction.push_back(i);
        parallel_for(first_of_direction.size(), [&](size_t group) {
            const size_t first = first_of_direction[group], direction = chunk[first].direction;
            for (size_t i = first; i < chunk.size() && chunk[i].direction == direction; ++i)
                tallies[direction].add(found[i]);
        });
        tasks = tasks.subspan(chunk.size());
    }
}

GoniophotometerProgress Run::state(const std::vector<PathTally>& tallies, double fraction,
                                   double tracing_since) const {
    GoniophotometerProgress state{};
    uint64_t done = 0;
    for (const PathTally& tally : tallies) {
        state.accuracy = std::max(state.accuracy, tally.accuracy());
        done += tally.counts().paths;
    }
    state.fraction = fraction;
    state.seconds = seconds();
    const double tracing = state.seconds - tracing_since;
    state.paths_per_second = static_cast<double>(done) / tracing;
    state.seconds_left = tracing * (1 - fraction) / fraction;
    if (settings_.max_seconds > 0)
        state.seconds_left =
            std::clamp(settings_.max_seconds - state.seconds, 0.0, state.seconds_left);
    return state;
}

/// Wave after wave, all directions advance by the same share of what is planned for them. How
/// large a wave is changes nothing in the result: it follows the machine's speed.
GoniophotometerCounts
Run::measure(const std::vector<uint64_t>& planned,
             const std::function<void(const GoniophotometerProgress&)>& progress) {
    const size_t directions = planned.size();
    std::vector<PathTally> tallies(directions, PathTally(table_));
    double total = 0;
    for (const uint64_t paths : planned)
        total += static_cast<double>(paths);
    double wave = 16.0 * thread_count(); // batches
    double share = 0;
    const double tracing_since = seconds();
    while (share < 1 && (share == 0 || !time_is_up())) {
        const double wave_since = seconds();
        share = std::min(1.0, share + wave * kBatchPaths / total);
        std::vector<Task> tasks;
        for (size_t d = 0; d < directions; ++d) {
            const double wanted = std::ceil(share * static_cast<double>(planned[d]) / kBatchPaths);
            const uint64_t until =
                share == 1 ? planned[d]
                           : std::min(planned[d], static_cast<uint64_t>(wanted) * kBatchPaths);
            for (uint64_t k = tallies[d].counts().paths; k < until; k += kBatchPaths)
                tasks.push_back({d, k, std::min(kBatchPaths, until - k)});
        }
        trace(tasks, tallies);
        if (progress)
            progress(state(tallies, share, tracing_since));
        const double took = seconds() - wave_since;
        if (took < 0.5)
            wave *= 2;
        else if (took > 1.5)
            wave = std::max(4.0 * thread_count(), wave / 2);
    }
    GoniophotometerCounts counts;
    for (size_t d = 0; d < directions; ++d) {
        tallies[d].write(table_, d);
        counts += tallies[d].counts();
    }
    return counts;
}

} // namespace

GoniophotometerCounts measure(const kernel::FibreTracer& tracer,
                              std::span<const FibreOptics> optics,
                              const GoniophotometerSettings& settings, BsdfTable& table,
                              const std::function<void(const GoniophotometerProgress&)>& progress) {
    if (!(settings.accuracy > 0))
        throw std::invalid_argument("the accuracy asked for is not positive");
    if (settings.max_events < 1)
        throw std::invalid_argument("a path is allowed no events");
    const size_t bands = table.bands.count();
    const std::vector<FibreMedium> media = fibre_media(optics, bands, tracer);
    const IncidentPathTracer paths{tracer, media, bands, settings.max_events, true};
    Run run(paths, settings, table);
    return run.measure(run.plan(), progress);
}

} // namespace rapport
