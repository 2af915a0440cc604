#pragma once

#include "vgsp/draft.h"

#include <string>

namespace rapport {

/// The draft as it can be woven: ends that are never threaded and picks that raise nothing are
/// trimmed, the rest reduced to its smallest repeat (with its colours). Throws a FileError
/// (`path` is for the message) if an end or pick never interlaces — an infinite float — naming it.
Draft weavable(const Draft& draft, const std::string& path);

} // namespace rapport
