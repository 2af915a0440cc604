#pragma once

#include <filesystem>
#include <fstream>
#include <functional>

namespace rapport {

/// Calls `write` with a temporary name beside `target`, then renames it to `target`, so that the
/// file appears whole or not at all; on an exception the temporary is removed. A folder that does
/// not exist or cannot be written is a FileError, and so is a target that is no plain file (a
/// folder, a device).
void write_atomically(const std::filesystem::path& target,
                      const std::function<void(const std::filesystem::path& temporary)>& write);

/// The same FileErrors where `target` cannot be written, before the work that is to fill it.
void check_writable(const std::filesystem::path& target);

/// write_atomically() through a binary stream; a disk that fills up is noticed, and is a FileError.
void write_stream_atomically(const std::filesystem::path& target,
                             const std::function<void(std::ofstream& stream)>& write);

} // namespace rapport
