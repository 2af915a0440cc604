#pragma once

#include <chrono>
#include <filesystem>
#include <map>
#include <vector>

namespace rapport {

/// Notices files that change on the disk, by their time and size.
class FileWatch {
  public:
    /// Looks at the file from now on, or, if it does already, forgets what changed until now.
    void add(const std::filesystem::path& file) { seen_[file] = state_of(file); }

    /// Looks at the file from now on, if it does not already.
    void keep(const std::filesystem::path& file) {
        if (!seen_.contains(file))
            add(file);
    }

    /// Those that have changed since they were last told or added; looks at most four times a
    /// second. A file that is gone has not changed: editors replace files by renaming.
    std::vector<std::filesystem::path> changed() {
        std::vector<std::filesystem::path> files;
        const auto now = std::chrono::steady_clock::now();
        if (now - looked_ < std::chrono::milliseconds(250))
            return files;
        looked_ = now;
        for (auto& [file, seen] : seen_)
            if (const State state = state_of(file); state.there && state != seen) {
                seen = state;
                files.push_back(file);
            }
        return files;
    }

  private:
    struct State {
        bool there = false;
        std::filesystem::file_time_type time;
        uintmax_t size = 0;

        bool operator==(const State&) const = default;
    };
    static State state_of(const std::filesystem::path& file) {
        std::error_code error;
        State state;
        state.time = std::filesystem::last_write_time(file, error);
        if (!error)
            state.size = std::filesystem::file_size(file, error);
        state.there = !error;
        return state;
    }

    std::map<std::filesystem::path, State> seen_;
    std::chrono::steady_clock::time_point looked_;
};

} // namespace rapport
