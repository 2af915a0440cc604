#include "renderer/scene/gltf/gltf.h"
#include "tests/fuzz/input_file.h"

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
    return rapport::tests::fuzz_file(
        "input.gltf", data, size,
        [](const std::filesystem::path& path) { rapport::read_gltf(path); });
}
