#include "tests/support/shared_data.h"

namespace rapport::tests {

std::filesystem::path shared_data() {
    const std::filesystem::path folder =
        std::filesystem::path(RAPPORT_SOURCE_DIR) / ".." / "shared" / "data";
    return std::filesystem::is_directory(folder) ? std::filesystem::canonical(folder)
                                                 : std::filesystem::path();
}

} // namespace rapport::tests
