#include "renderer/scene/imagemap.h"

#include "renderer/scene/file_bytes.h"

#include <fmt/format.h>

namespace rapport {
namespace {

/// The choice of that name, or a FileError that lists them; the first is the default.
template <class Choice>
Choice choose(const Params& params, const std::string& name,
              std::initializer_list<std::pair<const char*, Choice>> choices) {
    const std::string value = params.get_string(name, choices.begin()->first);
    std::string names;
    for (const auto& [text, choice] : choices) {
        if (value == text)
            return choice;
        names += fmt::format("{}\"{}\"", names.empty() ? "" : ", ", text);
    }
    params.fail(name, "one of " + names, fmt::format("\"{}\"", value));
}

} // namespace

std::shared_ptr<const PictureTexture> make_imagemap(const Params& params,
                                                    const std::filesystem::path& base_dir) {
    const std::string filename = params.get_string("filename", "");
    if (filename.empty())
        params.fail("filename", "\"string filename\" of a picture", "none");
    using Wrap = PictureMapping::Wrap;
    PictureMapping mapping;
    mapping.wrap_u = mapping.wrap_v = choose<Wrap>(
        params, "wrap", {{"repeat", Wrap::repeat}, {"black", Wrap::black}, {"clamp", Wrap::clamp}});
    mapping.linear = choose<bool>(params, "encoding", {{"sRGB", false}, {"linear", true}});
    choose<int>(params, "filter", {{"bilinear", 0}, {"point", 0}, {"trilinear", 0}, {"ewa", 0}});
    mapping.scale = {params.get_float("uscale", 1), params.get_float("vscale", 1)};
    mapping.offset = {params.get_float("udelta", 0), params.get_float("vdelta", 0)};
    const float scale = params.get_float("scale", 1);
    if (!(scale >= 0 && scale <= 1)) // so that no pixel reflects more than arrives
        params.fail("scale", "a number in [0, 1]", fmt::format("{}", scale));
    params.check_all_used();
    const std::filesystem::path path = base_dir / filename;
    const std::vector<char> file = read_file(path);
    const std::vector<unsigned char> bytes(file.begin(), file.end());
    return std::make_shared<PictureTexture>(std::make_shared<Picture>(bytes, path.string()),
                                            mapping, Rgb(scale));
}

} // namespace rapport
