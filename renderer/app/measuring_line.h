#pragma once

#include "renderer/app/commands.h"
#include "renderer/core/progress.h"
#include "vgsp/goniophotometer.h"

#include <fmt/format.h>
#include <iostream>
#include <optional>

namespace rapport {

/// The line on a terminal while cloths are measured; shows nothing where there is to be none.
class MeasuringLine {
  public:
    explicit MeasuringLine(const CommonOptions& common) : shown_(shows_progress(common)) {}

    void update(const std::filesystem::path& cloth, const GoniophotometerProgress& progress) {
        if (!shown_)
            return;
        if (!line_)
            line_.emplace(std::cerr, "measuring " + cloth.filename().string());
        const std::string reached =
            progress.pilot ? "pilot" : fmt::format("accuracy {:.4f}", progress.accuracy);
        line_->update(
            progress.fraction,
            fmt::format("{}, {:.0f} k paths/s", reached, 1e-3 * progress.paths_per_second),
            progress.seconds_left);
    }
    void end() { line_.reset(); }

  private:
    bool shown_;
    std::optional<ProgressLine> line_;
};

} // namespace rapport
