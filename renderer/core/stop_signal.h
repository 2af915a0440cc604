#pragma once

#include <functional>
#include <stdexcept>

namespace rapport {

/// Asked again and again in the course of long work, from any thread: true once nobody wants its
/// result any more. An empty one never stops.
using StopSignal = std::function<bool()>;

/// Thrown by work that was told to stop: there is no result.
struct Stopped : std::runtime_error {
    Stopped() : std::runtime_error("stopped before the end") {}
};

inline void throw_if(const StopSignal& stopped) {
    if (stopped && stopped())
        throw Stopped();
}

} // namespace rapport
