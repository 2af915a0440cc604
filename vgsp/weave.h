#pragma once

#include "vgsp/draft.h"

#include <string>

namespace rapport {

/// The draft as it can be woven: ends that are on no shaft and picks that raise none are dropped
/// (with a warning), the rest reduced to its smallest repeat along warp and weft, in which its
/// colours and yarns repeat too. Throws a FileError (`path` is for the message) that names the
/// first end or pick, counted from 1 in the draft as it was given, that never interlaces: an
/// infinite float.
Draft weavable(const Draft& draft, const std::string& path);

/// The draft, all of whose ends and picks are woven, repeated to so many.
Draft tiled(const Draft& draft, int ends, int picks);

} // namespace rapport
