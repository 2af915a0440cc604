#pragma once

#include "renderer/preview/session.h"

namespace rapport {

/// How long the window stays, and what it leaves; for tests and for pictures of the window.
struct ViewRun {
    int frames = 0;                   ///< 0 = until it is closed
    std::filesystem::path screenshot; ///< of the last of these frames, PNG; empty = none
};

/// Opens a window of `size` on the session and runs it. FileError where there is no display.
void view(Session& session, const glm::ivec2& size, const ViewRun& run);

} // namespace rapport
