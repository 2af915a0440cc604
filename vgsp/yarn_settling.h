#pragma once

#include "vgsp/yarn_system.h"

namespace rapport {

/// Lays the axes of `warp` and `weft`, of which all else is known, on one another: with the
/// crossing_lift(), held apart by their sections as these are inclined there. The outlines
/// reach as far above the cloth's middle as below it. Of the lift of floats there is as much as the
/// setts have room for. Throws a FileError at the cloth's path for yarns too thick for the sett.
void settle(const Cloth& cloth, YarnSystem& warp, YarnSystem& weft);

} // namespace rapport
