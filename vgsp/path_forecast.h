#pragma once

#include "vgsp/path_tally.h"

namespace rapport {

/// What a pilot tells of a longer run of the same incident direction. Much of ε may come from
/// bins next to the horizon, so small that hardly a path of the pilot has met one, and a single
/// path that does is felt: the pilot has to look beyond the bins that it has seen.
struct PathForecast {
    /// Where the bins of a direction (both blocks, one after the other) lie: regions of the sphere
    /// of about 0.1 sr, told by numbers below kRegions. Regions do not move with the light.
    static constexpr size_t kRegions = 128;
    static std::vector<uint8_t> regions(const BsdfTable& table, size_t direction);

    /// From a pilot and its regions. A bin's mean squared weight is that of its own paths and of
    /// one more that stands for the region: the posterior mean of a Poisson rate, under a gamma
    /// distribution of as little knowledge as one path, whose mean is the region's density; but no
    /// less than the bin's own paths say, because a highlight stands out of its region.
    PathForecast(const PathTally& pilot, std::span<const uint8_t> regions);

    /// ε²·N of the run. Not a number where nothing scatters.
    double error_of_one_path;
    /// Relative variance of that forecast, and of the ε² that a run of N paths will claim, times N.
    double own_variance, variance_of_one_path;

    /// By how much of itself ε² is to be planned lower than asked for, so that a run of `paths`
    /// claims no more, but for a risk of `sigmas`. `pilots` = how many times as large a pilot.
    double margin(double paths, double sigmas, double pilots = 1) const;
    /// How many paths make ε `accuracy` at most, but for that risk.
    double paths_needed(double accuracy, double sigmas) const;
};

} // namespace rapport
