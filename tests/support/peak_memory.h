#pragma once

#include <fstream>
#include <string>

namespace rapport::tests {

/// The most memory that this process has held so far [bytes]; 0 where the system does not tell.
inline double peak_memory() {
    std::ifstream status("/proc/self/status");
    for (std::string line; std::getline(status, line);)
        if (line.starts_with("VmHWM:"))
            return 1024 * std::stod(line.substr(6));
    return 0;
}

} // namespace rapport::tests
