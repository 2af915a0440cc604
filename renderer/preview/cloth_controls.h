#pragma once

#include "renderer/preview/cloth_worker.h"

namespace rapport {

/// ImGui controls of a cloth's weave, sett, yarns and fibres, which change `cloth` while they are
/// used. True once a change is complete: a slider let go, a crossing clicked.
bool draw_cloth_controls(Cloth& cloth);

/// A choice among a cloth's colourways, if it has any; true once another is chosen.
bool pick_colourway(const ClothTable& table, std::string& colourway);

} // namespace rapport
