#pragma once

namespace rapport {

/// The `rapport` command, for a `main` of anybody's: whatever materials, lights and shapes its
/// executable registers can be named in scenes. Prints results and errors; the value is the exit
/// status: 0 done, 1 a check failed, 2 bad input.
int run_program(int argc, char** argv);

} // namespace rapport
