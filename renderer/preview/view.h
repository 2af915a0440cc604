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

/// Opens a window of `size` on the session and runs it until it is closed. Edited cloths are saved
/// then, and where the graphics driver loses the window, after which another one goes on. Returns
/// the notes on those that were saved at the end, which no window shows. FileError where there is
/// no display.
std::vector<std::string> view(Session& session, const glm::ivec2& size, const ViewRun& run);

} // namespace rapport
