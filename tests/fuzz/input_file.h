#pragma once

#include "renderer/core/error.h"
#include "tests/support/file_bytes.h"
#include "tests/support/temporary_folder.h"

#include <cstdint>
#include <exception>

namespace rapport::tests {

/// Calls `read(path)` with the fuzzer's bytes in a file of that name. Bad input must end in a
/// FileError; anything else that is thrown, and any crash, is a find.
template <class Read>
int fuzz_file(const char* name, const uint8_t* data, size_t size, const Read& read) {
    static const TemporaryFolder folder;
    write_bytes(folder / name, {reinterpret_cast<const char*>(data), size});
    try {
        read(folder / name);
    } catch (const FileError& error) {
        if (error.expected.empty() || std::string(error.what()).find('\n') != std::string::npos)
            std::terminate(); // an error says in one line what was expected
    }
    return 0;
}

} // namespace rapport::tests
