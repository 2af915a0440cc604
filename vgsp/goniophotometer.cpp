#include "vgsp/goniophotometer.h"

#include "renderer/core/parallel.h"
#include "vgsp/checkpoint_file.h"
#include "vgsp/path_tally.h"

#include <algorithm>
#include <chrono>
#include <limits>
#include <numeric>
#include <stdexcept>

namespace rapport {
namespace {

constexpr uint64_t kBatchPaths = 1024;
constexpr uint64_t kPilotPaths = 1024;        ///< per direction, and twice as many again …
constexpr uint64_t kPlannedPerPilotPath = 32; ///< … while each of them plans so many, …
constexpr uint64_t kMostPilotPaths = 32768;   ///< … up to this
constexpr double kPilotTime = 0.5;            ///< of max_seconds, at most
constexpr size_t kFirstWave = 16;             ///< batches for each thread
constexpr uint64_t kMostPaths = uint64_t{1} << 40;
constexpr uint64_t kFirstPilotPath = kMostPaths;   ///< the pilot's numbers come after all others
constexpr size_t kWaitingBytes = size_t{64} << 20; ///< of deposits that wait to be summed

struct Task {
    size_t direction, group;
    uint64_t first, count;
};

class Run {
  public:
    Run(const PathTracers& tracers, const GoniophotometerSettings& settings, BsdfTable& table,
        const Checkpoint& checkpoint)
        : tracers_(tracers), settings_(settings), table_(table), checkpoint_(checkpoint),
          dyes_(1 + table.colourways.size()),
          waiting_batches_(std::max<size_t>(
              1,
              kWaitingBytes / (kBatchPaths * sizeof(float) * (1 + tracers.tracers[0].channels)))) {}

    /// Fills the table.
    GoniophotometerCounts
    measure(const std::function<void(const GoniophotometerProgress&)>& progress);

  private:
    double seconds() const {
        return std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
    }
    /// Or a share of it.
    bool time_is_up(double share = 1) const {
        return settings_.max_seconds > 0 && seconds() >= share * settings_.max_seconds;
    }
    /// One for each direction and set of dyes in turn.
    std::vector<PathTally> empty_tallies() const {
        std::vector<PathTally> tallies;
        for (size_t d = 0; d < table_.directions(); ++d) {
            throw_if(settings_.stopped);
            tallies.insert(tallies.end(), dyes_,
                           PathTally(table_, d, tracers_.realisations, tracers_.groups));
        }
        return tallies;
    }
    /// Those of one direction, in all dyes.
    std::span<const PathTally> of_direction(const std::vector<PathTally>& tallies,
                                            size_t direction) const {
        return std::span(tallies).subspan(direction * dyes_, dyes_);
    }
    /// Paths of one direction so far, in each group of bands.
    uint64_t paths(const std::vector<PathTally>& tallies, size_t direction) const {
        return tallies[direction * dyes_].paths();
    }
    uint64_t most_paths() const {
        return settings_.max_paths > 0 ? settings_.max_paths : kMostPaths;
    }
    /// Of the paths planned for a direction those that it gets.
    uint64_t allowed(uint64_t planned) const { return std::min(planned, most_paths()); }
    uint64_t all_allowed(std::span<const uint64_t> planned) const {
        return std::transform_reduce(planned.begin(), planned.end(), uint64_t{0}, std::plus{},
                                     [this](uint64_t paths) { return allowed(paths); });
    }
    bool out_of_paths(std::span<const uint64_t> planned) const {
        return std::ranges::max(planned) > most_paths();
    }
    /// How many paths each direction should get.
    std::vector<uint64_t>
    plan(const std::function<void(const GoniophotometerProgress&)>& progress) const;
    /// More of them for the directions that have had theirs and claim a larger ε than was asked.
    void extend(std::vector<uint64_t>& planned, const std::vector<PathTally>& tallies) const;
    /// Of all that is planned and allowed.
    double share_done(std::span<const uint64_t> planned,
                      const std::vector<PathTally>& tallies) const;
    /// Adds the batches of paths [first, until) of a direction, in all groups of bands.
    void add_tasks(std::vector<Task>& tasks, size_t direction, uint64_t first,
                   uint64_t until) const;
    /// Traces `tasks`, sorted by direction and then by path, and adds them to the tallies in that
    /// order.
    void trace(std::span<const Task> tasks, std::vector<PathTally>& tallies) const;
    /// Fills the table.
    GoniophotometerCounts write(const std::vector<PathTally>& tallies) const;
    GoniophotometerProgress state(const std::vector<PathTally>& tallies, double fraction) const;
    GoniophotometerProgress pilot_state(const std::vector<PathTally>& pilots) const;
    /// Takes up an earlier run, if there is one to take up.
    bool resume(std::vector<uint64_t>& planned, std::vector<PathTally>& tallies) const;
    /// Writes the checkpoint, if one is wanted; the seconds it took.
    double save(const std::vector<uint64_t>& planned, const std::vector<PathTally>& tallies) const;

    const PathTracers& tracers_;
    const GoniophotometerSettings& settings_;
    BsdfTable& table_;
    const Checkpoint& checkpoint_;
    size_t dyes_; ///< how many sets of them
    size_t waiting_batches_;
    std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
    double tracing_since_ = 0;    ///< what came before was planning
    double resumed_fraction_ = 0; ///< of the work, done by an earlier run
    uint64_t resumed_paths_ = 0;
};

void Run::add_tasks(std::vector<Task>& tasks, size_t direction, uint64_t first,
                    uint64_t until) const {
    // Batches end at their multiples, wherever a wave does.
    for (uint64_t k = first, end; k < until; k = end) {
        end = std::min(until, (k / kBatchPaths + 1) * kBatchPaths);
        for (size_t group = 0; group < tracers_.groups; ++group)
            tasks.push_back({direction, group, k, end - k});
    }
}

/// How many paths make ε `accuracy`, going by those of a tally.
uint64_t paths_needed(const PathTally& tally, double accuracy) {
    const double needed = std::ceil(tally.error_of_one_path() / square(accuracy));
    // Where nothing scatters there is no error to plan by, and paths are short: as many as a pilot
    // may have tell what goes straight through.
    if (needed == 0)
        return kMostPilotPaths;
    return needed < kMostPaths ? static_cast<uint64_t>(needed) : kMostPaths;
}

std::vector<uint64_t>
Run::plan(const std::function<void(const GoniophotometerProgress&)>& progress) const {
    std::vector<uint64_t> planned(table_.directions(), most_paths());
    if (most_paths() <= kPilotPaths)
        return planned;
    const auto out_of_time = [&] { return time_is_up(kPilotTime); };
    std::vector<PathTally> pilots = empty_tallies();
    std::vector<Task> tasks;
    do {
        tasks.clear();
        for (size_t d = 0; d < planned.size(); ++d) {
            const uint64_t done = paths(pilots, d), until = std::max(kPilotPaths, 2 * done);
            if (done == 0 ||
                until <= std::min(kMostPilotPaths, allowed(planned[d]) / kPlannedPerPilotPath))
                add_tasks(tasks, d, kFirstPilotPath + done, kFirstPilotPath + until);
        }
        const size_t wave = kFirstWave * thread_count();
        for (std::span<const Task> left = tasks; !left.empty() && !out_of_time();) {
            const std::span<const Task> some = left.first(std::min(left.size(), wave));
            trace(some, pilots);
            left = left.subspan(some.size());
            if (progress)
                progress(pilot_state(pilots));
        }
        for (size_t d = 0; d < planned.size(); ++d) {
            planned[d] = kBatchPaths;
            for (const PathTally& pilot : of_direction(pilots, d))
                planned[d] = std::max(planned[d], paths_needed(pilot, settings_.accuracy));
        }
    } while (!tasks.empty() && !out_of_time());
    return planned;
}

void Run::extend(std::vector<uint64_t>& planned, const std::vector<PathTally>& tallies) const {
    for (size_t d = 0; d < planned.size(); ++d) {
        throw_if(settings_.stopped);
        if (paths(tallies, d) < planned[d])
            continue;
        for (const PathTally& tally : of_direction(tallies, d)) {
            if (tally.accuracy() <= settings_.accuracy)
                continue;
            const uint64_t batches = paths_needed(tally, settings_.accuracy) / kBatchPaths + 1;
            planned[d] = std::min(kMostPaths, std::max(planned[d], batches * kBatchPaths));
        }
    }
}

void Run::trace(std::span<const Task> tasks, std::vector<PathTally>& tallies) const {
    while (!tasks.empty()) {
        const std::span<const Task> chunk = tasks.first(std::min(tasks.size(), waiting_batches_));
        std::vector<PathBatch> found(chunk.size());
        parallel_for(chunk.size(), [&](size_t i) {
            found[i] =
                trace_batch(tracers_, table_, chunk[i].direction, chunk[i].group, settings_.seed,
                            chunk[i].first, chunk[i].count, settings_.stopped);
        });
        std::vector<size_t> first_of_direction;
        for (size_t i = 0; i < chunk.size(); ++i)
            if (i == 0 || chunk[i].direction != chunk[i - 1].direction)
                first_of_direction.push_back(i);
        parallel_for(first_of_direction.size() * dyes_, [&](size_t task) {
            throw_if(settings_.stopped);
            const size_t first = first_of_direction[task / dyes_], dyes = task % dyes_;
            const size_t direction = chunk[first].direction;
            for (size_t i = first; i < chunk.size() && chunk[i].direction == direction; ++i)
                tallies[direction * dyes_ + dyes].add(found[i], dyes);
        });
        tasks = tasks.subspan(chunk.size());
    }
}

GoniophotometerProgress Run::state(const std::vector<PathTally>& tallies, double fraction) const {
    GoniophotometerProgress state{};
    uint64_t done = 0;
    for (size_t i = 0; i < tallies.size(); ++i) {
        state.accuracy = std::max(state.accuracy, tallies[i].accuracy());
        if (i % dyes_ == 0)
            done += tallies[i].counts().paths;
    }
    state.fraction = fraction;
    state.seconds = seconds();
    const double tracing = state.seconds - tracing_since_;
    state.paths_per_second = static_cast<double>(done - resumed_paths_) / tracing;
    state.seconds_left = tracing * (1 - fraction) / (fraction - resumed_fraction_);
    if (settings_.max_seconds > 0)
        state.seconds_left =
            std::clamp(settings_.max_seconds - state.seconds, 0.0, state.seconds_left);
    return state;
}

GoniophotometerProgress Run::pilot_state(const std::vector<PathTally>& pilots) const {
    double done = 0;
    for (size_t d = 0; d < table_.directions(); ++d)
        done += static_cast<double>(pilots[d * dyes_].counts().paths);
    constexpr double kUnknown = std::numeric_limits<double>::infinity();
    const double now = seconds();
    const double left = settings_.max_seconds > 0 ? settings_.max_seconds - now : kUnknown;
    return {kUnknown, 0, now, std::max(left, 0.0), done / now, true};
}

bool Run::resume(std::vector<uint64_t>& planned, std::vector<PathTally>& tallies) const {
    if (!checkpoint_.resume || !std::filesystem::exists(checkpoint_.path))
        return false;
    read_checkpoint(checkpoint_.path, table_, planned, tallies);
    return true;
}

double Run::save(const std::vector<uint64_t>& planned,
                 const std::vector<PathTally>& tallies) const {
    if (checkpoint_.path.empty())
        return 0;
    const double since = seconds();
    write_checkpoint(checkpoint_.path, table_, planned, tallies);
    return seconds() - since;
}

double Run::share_done(std::span<const uint64_t> planned,
                       const std::vector<PathTally>& tallies) const {
    uint64_t done = 0;
    for (size_t d = 0; d < planned.size(); ++d)
        done += std::min(paths(tallies, d), allowed(planned[d]));
    return static_cast<double>(done) / static_cast<double>(all_allowed(planned));
}

/// Wave after wave, all directions advance by the same share of what is planned for them. How
/// large a wave is changes nothing in the result: it follows the machine's speed.
GoniophotometerCounts
Run::measure(const std::function<void(const GoniophotometerProgress&)>& progress) {
    std::vector<uint64_t> planned;
    std::vector<PathTally> tallies = empty_tallies();
    if (!resume(planned, tallies)) {
        planned = plan(progress);
        save(planned, tallies);
    }
    for (size_t d = 0; d < planned.size(); ++d)
        resumed_paths_ += tallies[d * dyes_].counts().paths;
    double share = resumed_fraction_ = share_done(planned, tallies);
    tracing_since_ = seconds();
    double wave = static_cast<double>(kFirstWave * thread_count());
    for (bool first = true; share < 1 && (first || !time_is_up()); first = false) {
        const double wave_since = seconds();
        const auto total = static_cast<double>(all_allowed(planned));
        share = std::min(1.0, share + wave * kBatchPaths / total);
        std::vector<Task> tasks;
        for (size_t d = 0; d < planned.size(); ++d) {
            const uint64_t most = allowed(planned[d]);
            const double wanted = std::ceil(share * static_cast<double>(most) / kBatchPaths);
            const uint64_t until =
                share == 1 ? most : std::min(most, static_cast<uint64_t>(wanted) * kBatchPaths);
            add_tasks(tasks, d, paths(tallies, d), until);
        }
        trace(tasks, tallies);
        if (share == 1) {
            extend(planned, tallies);
            share = share_done(planned, tallies);
        }
        const double took = seconds() - wave_since;
        const double saving = share < 1 || out_of_paths(planned) ? save(planned, tallies) : 0;
        if (progress)
            progress(state(tallies, share));
        const double wanted = std::max(1.0, kWorkPerSaving * saving);
        if (took < 0.5 * wanted)
            wave *= 2;
        else if (took > 1.5 * wanted)
            wave /= 2;
        if (settings_.max_seconds > 0)
            wave = std::min(wave, wave * (settings_.max_seconds - seconds()) / took);
        wave = std::max(wave, 4.0 * thread_count());
    }
    GoniophotometerCounts counts = write(tallies);
    counts.out_of_time = share < 1;
    counts.out_of_paths = share == 1 && out_of_paths(planned);
    return counts;
}

GoniophotometerCounts Run::write(const std::vector<PathTally>& tallies) const {
    table_.realisation_error.assign(tracers_.realisations > 1 ? table_.directions() : 0, 0);
    std::vector<Scattering*> scattering{&table_};
    for (auto& [name, of_dyes] : table_.colourways) {
        throw_if(settings_.stopped);
        of_dyes = table_; // for its size
        scattering.push_back(&of_dyes);
    }
    GoniophotometerCounts counts;
    for (size_t d = 0; d < table_.directions(); ++d) {
        throw_if(settings_.stopped);
        for (size_t dyes = 0; dyes < dyes_; ++dyes)
            tallies[d * dyes_ + dyes].write(*scattering[dyes], d);
        table_.paths[d] = paths(tallies, d);
        counts += tallies[d * dyes_].counts();
    }
    return counts;
}

} // namespace

GoniophotometerCounts measure(std::span<const kernel::FibreTracer> realisations,
                              std::span<const FibreOptics> optics,
                              const GoniophotometerSettings& settings, BsdfTable& table,
                              const std::function<void(const GoniophotometerProgress&)>& progress,
                              const Checkpoint& checkpoint, const Colourways& colourways) {
    if (!(settings.accuracy > 0))
        throw std::invalid_argument("the accuracy asked for is not positive");
    if (settings.max_events < 1)
        throw std::invalid_argument("a path is allowed no events");
    if (realisations.empty() || realisations.size() > kBatchPaths)
        throw std::invalid_argument("no realisation of the cloth, or too many");
    const size_t bands = table.bands.count();
    const std::vector<std::vector<FibreMedium>> groups =
        media_of_groups(optics, bands, realisations[0], colourways);
    PathTracers tracers{realisations.size(), groups.size(), {}};
    const size_t channels = bands / groups.size() * (1 + colourways.size());
    for (const std::vector<FibreMedium>& media : groups)
        for (const kernel::FibreTracer& tracer : realisations)
            tracers.tracers.push_back({tracer, media, channels, settings.max_events, true});
    table.colourways.clear();
    for (const auto& [name, dyes] : colourways)
        table.colourways[name]; // filled in the end
    return Run(tracers, settings, table, checkpoint).measure(progress);
}

} // namespace rapport
