#pragma once

#include "renderer/app/canvas.h"

#include <string>

namespace rapport {

/// Width [px] of a line of text at the size of draw_text().
double text_width(const std::string& words);
/// Black text of 12 px, its base line starting at (x, y); in DejaVu Sans, or where that is not
/// installed in Dear ImGui's own letters, which are Latin only.
void draw_text(Canvas& canvas, double x, double y, const std::string& words);

} // namespace rapport
