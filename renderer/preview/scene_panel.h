#pragma once

#include "renderer/preview/session.h"

namespace rapport {

/// Draws the controls of what the garment wears, its light, the display, and how the picture comes
/// along, into the current ImGui window; what a person does with them goes to the session.
/// `selected` is the cloth file that the cloth panel edits.
void draw_scene_panel(Session& session, std::filesystem::path& selected);

} // namespace rapport
