#include "renderer/core/atomic_file.h"

#include "renderer/core/error.h"
#include "tests/support/file_bytes.h"
#include "tests/support/temporary_folder.h"

#include <gtest/gtest.h>

using namespace rapport;
using namespace rapport::tests;

namespace {

size_t files_in(const TemporaryFolder& folder) {
    return std::distance(std::filesystem::directory_iterator(folder.path()), {});
}

} // namespace

TEST(AtomicFile, AppearsWhole) {
    const TemporaryFolder folder;
    write_atomically(folder / "out", [&](const std::filesystem::path& temporary) {
        EXPECT_EQ(temporary.parent_path(), folder.path()); // a rename must stay on one disk
        EXPECT_FALSE(std::filesystem::exists(folder / "out"));
        write_bytes(temporary, "one");
    });
    EXPECT_EQ(read_bytes(folder / "out"), "one");
    write_stream_atomically(folder / "out", [](std::ofstream& stream) { stream << "two"; });
    EXPECT_EQ(read_bytes(folder / "out"), "two");
    EXPECT_EQ(files_in(folder), 1u);
}

TEST(AtomicFile, KeepsTheOldFileWhenWritingFails) {
    const TemporaryFolder folder;
    write_bytes(folder / "out", "old");
    const auto fails = [](const std::filesystem::path& temporary) {
        write_bytes(temporary, "half");
        throw std::runtime_error("interrupted");
    };
    EXPECT_THROW(write_atomically(folder / "out", fails), std::runtime_error);
    EXPECT_EQ(read_bytes(folder / "out"), "old");
    EXPECT_EQ(files_in(folder), 1u);
    EXPECT_THROW(
        write_stream_atomically(folder / "out",
                                [](std::ofstream& stream) { stream.setstate(std::ios::badbit); }),
        FileError);
    EXPECT_EQ(read_bytes(folder / "out"), "old");
    EXPECT_EQ(files_in(folder), 1u);
}

TEST(AtomicFile, RefusesPlacesThatCannotHoldAFile) {
    const TemporaryFolder folder;
    const auto never = [](const std::filesystem::path&) { FAIL() << "nothing can be written"; };
    for (const std::filesystem::path& target :
         {folder / "absent/out", folder.path(), std::filesystem::path("/dev/null")}) {
        EXPECT_THROW(write_atomically(target, never), FileError) << target;
        EXPECT_THROW(check_writable(target), FileError) << target;
    }
    check_writable(folder / "out");
    EXPECT_EQ(files_in(folder), 0u);
    EXPECT_TRUE(std::filesystem::is_character_file("/dev/null"));
}
