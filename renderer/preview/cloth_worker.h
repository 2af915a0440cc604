#pragma once

#include "materials/table/table_bsdf.h"
#include "renderer/preview/rising_measurement.h"

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <map>
#include <mutex>
#include <optional>
#include <set>
#include <thread>

namespace rapport {

/// A cloth file's table, ready to render with; constant.
struct ClothTable {
    std::shared_ptr<const Cloth> cloth;     ///< nothing for a table that was stored
    std::shared_ptr<const BsdfTable> table; ///< of all colourways
    std::map<std::string, std::shared_ptr<const TableBsdf>> dyed; ///< by colourway; "" = its own
    RisingMeasurement::Swatches swatches;   ///< its fibres by colourway; none of a stored table
    std::set<std::filesystem::path> inputs; ///< the files that it was read from, if any
    double accuracy = 0;                    ///< ε
    double seconds = 0;                     ///< since it was asked for
};

/// Reads a `.bsdf`, or measures a `.toml` or `.wif` in haste.
ClothTable first_table(const std::filesystem::path& file, const MeasuringWatch& watch = {},
                       const StopSignal& stopped = {});

/// Gets cloths' tables in the background: stored ones are read, others measured at rising accuracy
/// down to ε = 0.1, the coarsest table first. What is asked for takes the place of what was asked
/// for under the same name before, whose work ends at once.
class ClothWorker {
  public:
    ClothWorker();
    ClothWorker(const ClothWorker&) = delete;
    ClothWorker& operator=(const ClothWorker&) = delete;
    ~ClothWorker();

    /// Asks for the table of a file as it is on the disk, or, with a cloth, of that cloth in its
    /// place. Returns the number of the request, counted up from 1.
    uint64_t request(const std::filesystem::path& file, std::shared_ptr<const Cloth> cloth = {});
    /// Ends work on a file.
    void forget(const std::filesystem::path& file);

    struct News {
        std::filesystem::path file;
        uint64_t request = 0;
        std::shared_ptr<const ClothTable> table;  ///< or
        std::string error{};                      ///< why there is none
        std::set<std::filesystem::path> inputs{}; ///< with an error: the files that were read
    };
    /// What there is since the last call.
    std::vector<News> take_news();
    /// Of the file that is worked on now, else empty.
    std::filesystem::path working_on() const;
    /// From the last request that ended other work to the moment when that had ended [s].
    double seconds_to_stop() const;

  private:
    using Clock = std::chrono::steady_clock;
    struct Task {
        uint64_t request = 0;
        std::filesystem::path file;
        std::shared_ptr<const Cloth> cloth;
        std::set<std::filesystem::path> inputs;
        Clock::time_point asked;
        std::optional<RisingMeasurement> measurement;
        uint64_t told_paths = 0; ///< of the table that was told last
    };

    void run();
    void stop_current(); ///< with the mutex held
    /// One step of a task; what it has to tell, and whether there is more to do.
    bool advance(Task& task, const StopSignal& stopped);
    void tell(News news);

    mutable std::mutex mutex_;
    std::condition_variable changed_;
    std::map<std::filesystem::path, std::shared_ptr<Task>> tasks_;
    std::shared_ptr<Task> current_;
    std::atomic<bool> stop_current_ = false, closing_ = false;
    Clock::time_point stopped_at_;
    double seconds_to_stop_ = 0;
    std::vector<News> news_;
    uint64_t requests_ = 0;
    std::thread thread_; ///< last, for it uses all others
};

} // namespace rapport
