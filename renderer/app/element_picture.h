#pragma once

#include "renderer/app/canvas.h"
#include "vgsp/cloth.h"

namespace rapport {

/// The cloth's micro-element from above (warp upwards), and below that cut along the first pick,
/// seen along the warp, and along the first end, seen along the weft; the face is up in both cuts.
/// Fibres are coloured by their yarn. All to one scale; of large repeats a part.
Canvas element_picture(const Cloth& cloth);

} // namespace rapport
