#pragma once

#include "renderer/preview/session.h"

#include <functional>

namespace rapport {

/// How long the window stays, and what it leaves; for tests and for pictures of the window.
struct ViewRun {
    int frames = 0;                             ///< 0 = until it is closed
    std::filesystem::path screenshot;           ///< of the last of these frames, PNG; empty = none
    std::function<void(int)> before_frame = {}; ///< called with the number of each, from 0
};

/// Opens a window of `size` on the session and runs it; where the graphics driver loses it, edited
/// cloths are saved and another window goes on. FileError where there is no display.
void view(Session& session, const glm::ivec2& size, const ViewRun& run);

} // namespace rapport
