#pragma once

#include <cstdlib>

namespace rapport::tests {

/// True under `bash tests/run.sh long`: tests then use their full counts.
inline bool long_run() { return std::getenv("RAPPORT_LONG") != nullptr; }

} // namespace rapport::tests
