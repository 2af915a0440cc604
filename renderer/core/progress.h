#pragma once

#include <atomic>
#include <chrono>
#include <functional>
#include <iosfwd>
#include <mutex>
#include <optional>
#include <string>
#include <string_view>

namespace rapport {

/// "0:07", "12:34", "3:00:05" for a length of time in seconds, rounded to the nearest.
std::string format_duration(double seconds);

/// Told again and again in the course of long work, from any thread, which share of it is done,
/// [0, 1]. An empty one is not told.
using ProgressSignal = std::function<void(double fraction)>;

/// Counts steps that take about the same time, on any thread, and tells how far they have come.
class StepCount {
  public:
    StepCount(size_t steps, ProgressSignal told) : steps_(steps), told_(std::move(told)) {}

    void add(size_t steps = 1) {
        const size_t done = done_ += steps;
        if (told_)
            told_(static_cast<double>(done) / static_cast<double>(steps_));
    }

  private:
    size_t steps_;
    std::atomic<size_t> done_ = 0;
    ProgressSignal told_;
};

/// A line on a terminal that tells how far long work has come, rewritten in place at most five
/// times a second and wiped at the end. May be updated from any thread.
class ProgressLine {
  public:
    /// `title` stands first on the line; `out` outlives this.
    ProgressLine(std::ostream& out, std::string title);
    ProgressLine(const ProgressLine&) = delete;
    ProgressLine& operator=(const ProgressLine&) = delete;
    ~ProgressLine();

    /// `fraction` of the work is done, [0, 1]; `measure` is what counts in it ("1.2 M paths/s,
    /// accuracy 0.031"). Without `seconds_left` the time left is that of constant speed.
    void update(double fraction, std::string_view measure = {},
                std::optional<double> seconds_left = {});

  private:
    using Clock = std::chrono::steady_clock;

    std::ostream& out_;
    std::string title_;
    std::mutex mutex_;
    Clock::time_point start_ = Clock::now();
    std::optional<Clock::time_point> last_;
};

} // namespace rapport
