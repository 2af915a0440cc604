#include "renderer/scene/pbrt/pbrt_parser.h"
#include "renderer/scene/scene_builder.h"
#include "tests/fuzz/input_file.h"

using namespace rapport;

/// The scene file, and everything that it describes without naming another file.
extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
    return tests::fuzz_file("input.pbrt", data, size, [](const std::filesystem::path& path) {
        std::vector<std::string> warnings;
        const BuildOptions options{{},
                                   [](const std::filesystem::path& table,
                                      const std::string&) -> std::shared_ptr<const TableBsdf> {
                                       throw FileError(table.string(), "", "a table", "none");
                                   }};
        build_scene(parse_pbrt(path), options, warnings);
    });
}
