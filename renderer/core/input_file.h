#pragma once

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <map>
#include <set>
#include <string>

namespace rapport {

/// A file opened for reading in binary, and its length in bytes.
struct InputFile {
    std::ifstream stream;
    uint64_t size = 0;
};

/// What this thread opens with `open_input` as long as the log lives; there may be several, one
/// within another.
class InputLog {
  public:
    enum class Of { names, bytes };
    explicit InputLog(Of of);
    InputLog(const InputLog&) = delete;
    InputLog& operator=(const InputLog&) = delete;
    ~InputLog();

    /// By the names of the files without their folders, hashes of their bytes in the order of
    /// opening; empty in a log of names. Tells work on some files from work on others, wherever
    /// they lie.
    const std::map<std::string, std::string>& hashes() const { return hashes_; }
    /// Canonical paths, also of files that were not there.
    const std::set<std::filesystem::path>& files() const { return files_; }

  private:
    friend InputFile open_input(const std::filesystem::path& path);

    const Of of_;
    std::map<std::string, std::string> hashes_;
    std::set<std::filesystem::path> files_;
    InputLog* outer_;
};

/// A file that is missing, unreadable, or no plain file (a folder, a device) is a FileError.
InputFile open_input(const std::filesystem::path& path);

/// ".bsdf", in lower case.
std::string lower_extension(const std::filesystem::path& path);

} // namespace rapport
