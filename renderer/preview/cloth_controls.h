#pragma once

#include "vgsp/cloth.h"

namespace rapport {

/// ImGui controls of a cloth's weave, sett, yarns and fibres, which change `cloth` while they are
/// used. True once a change is complete: a slider let go, a crossing clicked.
bool draw_cloth_controls(Cloth& cloth);

} // namespace rapport
