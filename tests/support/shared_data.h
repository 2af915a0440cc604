#pragma once

#include <filesystem>

namespace rapport::tests {

/// The folder of real inputs that lies beside the checkout and is no part of it; empty if absent.
std::filesystem::path shared_data();

} // namespace rapport::tests

/// Puts the folder in `variable`, or skips the test with a plain message where it is absent.
#define RAPPORT_SHARED_DATA_OR_SKIP(variable)                                                      \
    const std::filesystem::path variable = rapport::tests::shared_data();                          \
    if (variable.empty())                                                                          \
    GTEST_SKIP() << "the folder of shared inputs (../shared/data) is not here"
