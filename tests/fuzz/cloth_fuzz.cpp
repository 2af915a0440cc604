#include "tests/fuzz/input_file.h"
#include "vgsp/cloth.h"

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
    return rapport::tests::fuzz_file(
        "input.toml", data, size,
        [](const std::filesystem::path& path) { rapport::read_cloth(path); });
}
