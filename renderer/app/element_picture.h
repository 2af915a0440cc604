#pragma once

#include "renderer/app/drawing.h"
#include "vgsp/cloth.h"

namespace rapport {

/// A cloth's micro-element, all to one scale; of large repeats a part. Fibres are coloured by their
/// yarn.
struct ElementViews {
    double scale; ///< pixels per µm
    Canvas top;   ///< from the face, warp upwards
    /// Along the first pick, seen along the warp, the face up.
    Canvas weft_cut;
    /// Along the first end, seen along the weft, warp upwards and the face to the left.
    Canvas warp_cut;
};

ElementViews element_views(const Cloth& cloth);

/// The three as in a drawing of three views, each cut beside the edge that it is parallel to, with
/// names and a scale.
Drawing element_picture(const Cloth& cloth);

} // namespace rapport
