#pragma once

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <map>
#include <string>

namespace rapport {

/// A file opened for reading in binary, and its length in bytes.
struct InputFile {
    std::ifstream stream;
    uint64_t size = 0;
};

/// What this thread opens with `open_input` as long as the log lives, the innermost if there are
/// several: by the names of the files without their folders, hashes of their bytes in the order of
/// opening. Tells work on some files from work on others, wherever they lie.
class InputLog {
  public:
    InputLog();
    InputLog(const InputLog&) = delete;
    InputLog& operator=(const InputLog&) = delete;
    ~InputLog();

    const std::map<std::string, std::string>& hashes() const { return hashes_; }

  private:
    friend InputFile open_input(const std::filesystem::path& path);

    std::map<std::string, std::string> hashes_;
    InputLog* outer_;
};

/// A file that is missing, unreadable, or no plain file (a folder, a device) is a FileError.
InputFile open_input(const std::filesystem::path& path);

/// ".bsdf", in lower case.
std::string lower_extension(const std::filesystem::path& path);

} // namespace rapport
