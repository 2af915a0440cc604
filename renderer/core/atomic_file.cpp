#include "renderer/core/atomic_file.h"

#include "renderer/core/error.h"

#include <atomic>
#include <cerrno>
#include <fmt/format.h>
#include <system_error>
#include <unistd.h>

namespace rapport {
namespace {

namespace fs = std::filesystem;

/// A name that no other writer uses, of this process or another.
fs::path temporary_beside(const fs::path& target) {
    static std::atomic<unsigned> counter = 0;
    fs::path temporary = target;
    temporary += fmt::format(".{}-{}.tmp", getpid(), counter++);
    return temporary;
}

/// Creates the file empty, so that an unwritable place is told before any work is done.
void create(const fs::path& temporary, const fs::path& target) {
    const fs::path folder = target.has_parent_path() ? target.parent_path() : fs::path(".");
    std::error_code ignored;
    if (!fs::is_directory(folder, ignored))
        throw FileError(target.string(), "", "an existing folder to write to",
                        "no folder \"" + folder.string() + "\"");
    if (fs::exists(target, ignored) && !fs::is_regular_file(target, ignored))
        throw FileError(target.string(), "", "a plain file to replace",
                        fs::is_directory(target, ignored) ? "a folder" : "a device or the like");
    errno = 0;
    if (!std::ofstream(temporary, std::ios::binary))
        throw FileError(target.string(), "", "a place to write to",
                        std::generic_category().message(errno));
}

/// Removes the temporary unless it was renamed.
class TemporaryGuard {
  public:
    explicit TemporaryGuard(fs::path path) : path_(std::move(path)) {}
    TemporaryGuard(const TemporaryGuard&) = delete;
    TemporaryGuard& operator=(const TemporaryGuard&) = delete;
    ~TemporaryGuard() {
        std::error_code ignored;
        fs::remove(path_, ignored); // no longer there once renamed
    }

  private:
    fs::path path_;
};

} // namespace

void write_atomically(const fs::path& target, const std::function<void(const fs::path&)>& write) {
    const fs::path temporary = temporary_beside(target);
    create(temporary, target);
    const TemporaryGuard guard(temporary);
    write(temporary);
    std::error_code error;
    fs::rename(temporary, target, error);
    if (error)
        throw FileError(target.string(), "", "a file that can be replaced", error.message());
}

void check_writable(const fs::path& target) {
    const fs::path temporary = temporary_beside(target);
    create(temporary, target);
    const TemporaryGuard guard(temporary);
}

void write_stream_atomically(const fs::path& target,
                             const std::function<void(std::ofstream&)>& write) {
    write_atomically(target, [&](const fs::path& temporary) {
        std::ofstream stream(temporary, std::ios::binary | std::ios::trunc);
        errno = 0;
        write(stream);
        stream.close();
        if (!stream)
            throw FileError(target.string(), "", "room for the whole file",
                            errno ? std::generic_category().message(errno) : "a failed write");
    });
}

} // namespace rapport
