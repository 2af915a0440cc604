#pragma once

#include "materials/table/direction_mesh.h"
#include "renderer/core/bands.h"

#include <span>
#include <vector>

namespace rapport {

/// Intensity inside a bin over its (ξ, η), mean·(1 + ξ·slope_xi + η·slope_eta): equal areas of
/// (ξ, η) are equal solid angles, so that the mean is kept whatever the slopes. |ξ|, |η| ≤ 1.
struct BinPlane {
    Rgb mean;
    float slope_xi, slope_eta; ///< relative; of the mean over the channels, for all of them

    Rgb at(float xi, float eta) const { return mean * (1 + slope_xi * xi + slope_eta * eta); }
};

/// Second-order reconstruction of intensity [1/sr] from the bin means of one hemisphere of exits,
/// as in finite-volume schemes (van Leer 1979): the slope of each bin is that of the line through
/// its neighbours' means, one-sided at the horizon, scaled down where the plane would fall below 0
/// in a corner. Slopes limited to keep extrema (minmod) would flatten every highlight into its bin.
/// Means must be ≥ 0.
std::vector<BinPlane> reconstruct(const DirectionMesh& mesh, const ExitBins& exits,
                                  std::span<const Rgb> means);

/// Draws (ξ, η) in [−1, 1]² with density ∝ 1 + a·ξ + b·η from uniform `u`, where |a| + |b| ≤ 1.
glm::vec2 sample_plane(float a, float b, const glm::vec2& u);

} // namespace rapport
