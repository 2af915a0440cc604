#pragma once

#include <span>
#include <vector>

namespace rapport {

/// Where ends and picks lie that touch at every crossing, as elastic threads at rest. Over the
/// shared heights, which are balance·separation of an end and (balance − 1)·separation of a pick,
/// both lie as much higher [end · picks + pick, µm] as minimises
///     (1 − balance)·Σ (bend of an end at a pick)² + balance·Σ (bend of a pick at an end)²,
/// their bending energy for small slopes, a bend being the second difference of heights along the
/// thread; the end's height minus the pick's stays `separation` [end · picks + pick, µm]. All
/// repeats. balance ∈ [0, 1].
///
/// In plain weave, and in twills, where ends and picks interlace alike, there is no lift: of a
/// separation of ±d the warp takes Peirce's crimp height ±balance·d and the weft the rest, so that
/// each yarn has two heights. In satins the picks that rise beside an end lift the middle of its
/// floats to a third. Cloth stays flat: waves of more than some 35 threads are held down to the
/// shared heights, from which a departure z costs 1e-3·z² at each crossing.
///
/// `start` is the lift for other separations, to go on from; none where it is empty.
std::vector<double> crossing_lift(std::span<const double> separation, int ends, int picks,
                                  double balance, std::vector<double> start = {});

} // namespace rapport
