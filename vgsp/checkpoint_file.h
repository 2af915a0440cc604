#pragma once

#include "vgsp/path_tally.h"

#include <filesystem>

namespace rapport {

/// A goniophotometer's run on its way, in the tensor file container: `run`, a JSON object of the
/// table's metadata, incident directions and colourways; `planned` [D], paths; `sums` [D·C, …] and
/// `path_counts` [D·C, …], the tallies' own for each direction in C sets of dyes, to the last bit.
void write_checkpoint(const std::filesystem::path& path, const BsdfTable& table,
                      std::span<const uint64_t> planned, std::span<const PathTally> tallies);

/// FileError where the file is damaged, or of a run that `table` and `tallies` are not laid out
/// for: its message names what differs.
void read_checkpoint(const std::filesystem::path& path, const BsdfTable& table,
                     std::vector<uint64_t>& planned, std::span<PathTally> tallies);

} // namespace rapport
