#pragma once

#include "renderer/integrator/film.h"

namespace rapport {

/// Share of a picture's tiles that must reach the noise asked for each on its own.
constexpr double kTileShare = 0.95;

/// Whether the relative noise (Film::Noise::relative) of the picture and of 95 % of its tiles is at
/// most `error`.
bool reaches(const Film& film, double error);

/// How many samples each tile should have next, for a picture that `reaches` the error with little
/// work: no fewer than it has, and none more for a picture that does.
///
/// A tile of variance s per sample needs s / v of them for the variance v. The 95 % of tiles that
/// need the fewest get v = (error · mean)² at most, and the others as many samples as the last of
/// these: given up, they would be patches of noise for all to see. The picture's mean of v is
/// bounded in the same way, which costs the least samples at v ∝ √s (Lagrange), so v is the smaller
/// of the two. What is planned for a tile comes from its 256 pixels together, so that a pixel's own
/// samples hardly decide how many there will be: to stop a pixel when it looks good would make it
/// look better than it is. A plan at most quadruples a tile's samples, because few samples tell
/// little of rare bright ones.
std::vector<int> plan_samples(const Film& film, double error);

} // namespace rapport
