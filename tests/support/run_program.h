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

/// Runs `rapport` here, quietly, and kills it after so many microseconds, unless they are 0;
/// whether that came before its end. A run that fails throws std::runtime_error.
bool run_and_kill_program(std::vector<std::string> arguments, unsigned after);

} // namespace rapport::tests
