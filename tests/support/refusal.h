#pragma once

#include "renderer/core/error.h"

#include <gtest/gtest.h>

namespace rapport::tests {

/// The FileError, of one line, that `read()` ends in; one that found "accepted" if it does not.
template <class Read> FileError refusal_of(const Read& read) {
    try {
        read();
    } catch (const FileError& error) {
        EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos);
        return error;
    }
    return FileError("", "", "", "accepted");
}

} // namespace rapport::tests
