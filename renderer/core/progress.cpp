#include "renderer/core/progress.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <ostream>

namespace rapport {
namespace {

constexpr auto kInterval = std::chrono::milliseconds(200);
constexpr std::string_view kEraseLine = "\r\x1b[K"; // to column one, then clear to the right

constexpr double kLongest = 1e9; // seconds

} // namespace

std::string format_duration(double seconds) {
    const auto whole = std::llround(std::clamp(seconds, 0.0, kLongest));
    const auto hours = whole / 3600, minutes = whole / 60 % 60;
    return hours > 0 ? fmt::format("{}:{:02}:{:02}", hours, minutes, whole % 60)
                     : fmt::format("{}:{:02}", minutes, whole % 60);
}

ProgressLine::ProgressLine(std::ostream& out, std::string title)
    : out_(out), title_(std::move(title)) {}

ProgressLine::~ProgressLine() {
    if (last_)
        out_ << kEraseLine << std::flush;
}

void ProgressLine::update(double fraction, std::string_view measure,
                          std::optional<double> seconds_left) {
    const std::scoped_lock lock(mutex_);
    const Clock::time_point now = Clock::now();
    if (last_ && now - *last_ < kInterval)
        return;
    last_ = now;

    fraction = std::clamp(fraction, 0.0, 1.0);
    const double elapsed = std::chrono::duration<double>(now - start_).count();
    if (!seconds_left && fraction > 0)
        seconds_left = elapsed * (1 - fraction) / fraction;
    std::string line = fmt::format("{} {:3.0f} %", title_, 100 * fraction);
    if (!measure.empty())
        line += fmt::format(", {}", measure);
    if (seconds_left && std::isfinite(*seconds_left))
        line += fmt::format(", {} left", format_duration(*seconds_left));
    out_ << kEraseLine << line << std::flush;
}

} // namespace rapport
