#pragma once

#include "renderer/app/drawing.h"
#include "vgsp/cloth.h"

namespace rapport {

/// A cloth's micro-element, all to one scale; of large repeats a part. Fibres are coloured by their
/// yarn.
struct ElementViews {
    double scale;    ///< pixels per µm
    Canvas top;      ///< from the face, warp upwards
    Canvas weft_cut; ///< along the first pick, seen along the warp, the face up
    Canvas warp_cut; ///< along the first end, seen along the weft, the face up
};

ElementViews element_views(const Cloth& cloth);

/// The three below each other.
Drawing element_picture(const Cloth& cloth);

} // namespace rapport
