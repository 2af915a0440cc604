#pragma once

#include "materials/table/direction_mesh.h"
#include "materials/table/float4.h"
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

/// Draws ξ and η (two lanes), from 0 to 1 across a bin, with density 1 + Σ slope·(2·place − 1),
/// Σ |slope| ≤ 1, from uniform `u` and `turn`. The mean density of a place and of its opposite is
/// 1: `u` stays where it is, or is turned about the middle.
inline Float4 sample_plane(Float4 slope, Float4 u, Float4 turn) {
    const Float4 rises = slope * (2 * u - 1);
    const Float4 density = 1 + four(rises[0] + rises[1]);
    return 2 * turn < density ? u : 1 - u;
}

} // namespace rapport
