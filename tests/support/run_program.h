#pragma once

#include <string>
#include <vector>

namespace rapport::tests {

struct ProgramRun {
    int status; ///< exit status, or −signal where one ended it
    std::string out, err;
};

/// Runs the `rapport` program in `folder` with these arguments.
ProgramRun run_program(const std::vector<std::string>& arguments, const std::string& folder = ".");

/// The same for another program, looked for in PATH unless it is named with its folder.
ProgramRun run_executable(const std::string& program, const std::vector<std::string>& arguments,
                          const std::string& folder = ".");

} // namespace rapport::tests
