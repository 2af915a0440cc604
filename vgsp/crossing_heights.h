#pragma once

#include <span>
#include <vector>

namespace rapport {

/// Heights of the yarns' axes over their crossings [µm]: [end · picks + pick].
struct CrossingHeights {
    std::vector<double> warp, weft;
};

/// Where ends and picks lie that touch at every crossing, as elastic threads at rest: their heights
/// minimise
///     (1 − balance)·Σ (bend of an end at a pick)² + balance·Σ (bend of a pick at an end)²,
/// their bending energy for small slopes, a bend being the second difference of heights along the
/// thread, while warp − weft = `separation` [end · picks + pick, µm]. All repeats.
///
/// In plain weave, and in twills, where ends and picks interlace alike, this shares out Peirce's
/// crimp heights: of a separation of ±d the warp takes ±balance·d and the weft the rest, so that
/// each yarn has two heights. In satins the picks that rise beside an end lift the middle of its
/// floats to a third. Cloth stays flat: waves of more than some 35 threads are held down to those
/// shared heights, from which a departure z costs 1e-3·z² at each crossing. balance ∈ [0, 1].
///
/// `lift` ∈ [0, 1] is how far they get from the shared heights to those of least energy.
CrossingHeights crossing_heights(std::span<const double> separation, int ends, int picks,
                                 double balance, double lift = 1);

} // namespace rapport
