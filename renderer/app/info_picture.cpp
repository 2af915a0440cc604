#include "renderer/app/info_picture.h"

#include "renderer/app/drawing.h"
#include "renderer/app/element_picture.h"
#include "renderer/app/table_picture.h"
#include "renderer/core/error.h"
#include "renderer/core/input_file.h"
#include "renderer/core/srgb.h"
#include "renderer/integrator/path_tracer.h"
#include "renderer/integrator/streaks.h"
#include "renderer/scene/model_scene.h"
#include "renderer/scene/scene_builder.h"
#include "vgsp/cloth.h"

#include <algorithm>
#include <functional>
#include <map>

namespace rapport {
namespace {

constexpr Canvas::Colour kWarpUp{0.1f, 0.1f, 0.12f}, kLine{0.75f, 0.75f, 0.78f}, kWeftUp{1, 1, 1};

/// Warp up in black, as on point paper; pick 1 at the bottom, end 1 at the left.
Drawing drawdown(const Draft& draft) {
    constexpr int kSide = 800; // of the longer one, as far as crossings of whole pixels allow
    const int cell = std::clamp(kSide / std::max(draft.ends, draft.picks), 1, 60);
    const int gap = cell > 3 ? 1 : 0;
    const glm::dvec2 size(cell * draft.ends + gap, cell * draft.picks + gap);
    Drawing drawing(size.x, size.y);
    drawing.rectangle({0, 0}, size, gap ? kLine : kWeftUp);
    for (int pick = 0; pick < draft.picks; ++pick)
        for (int end = 0; end < draft.ends; ++end) {
            const glm::dvec2 low(cell * end + gap, cell * (draft.picks - 1 - pick) + gap);
            if (gap || draft.up(end, pick))
                drawing.rectangle(low, low + double(cell - gap),
                                  draft.up(end, pick) ? kWarpUp : kWeftUp);
        }
    return drawing;
}

Drawing picture(Canvas pixels) {
    Drawing drawing(pixels.width(), pixels.height());
    drawing.image({0, 0}, std::move(pixels));
    return drawing;
}

/// The frames along which a cloth would lie on the model: streaks along the warp.
Drawing frames(const std::filesystem::path& model) {
    constexpr glm::ivec2 kSize{900, 900};
    SceneDescription description = describe_model(model, kSize);
    description.settings.samples = 4;
    description.settings.max_depth = 1; // only what is seen first counts
    std::vector<std::string> warnings;
    const Scene scene = build_scene(description, {}, warnings);
    const Image streaks = warp_streaks(render(scene).image(), scene.camera);
    Canvas canvas(streaks.width, streaks.height, {0, 0, 0});
    const auto& red = *streaks.find("R");
    const auto& green = *streaks.find("G");
    const auto& blue = *streaks.find("B");
    for (int y = 0; y < streaks.height; ++y)
        for (int x = 0; x < streaks.width; ++x) {
            const size_t i = static_cast<size_t>(y) * streaks.width + x;
            canvas.set(x, y, {encode_srgb(red[i]), encode_srgb(green[i]), encode_srgb(blue[i])});
        }
    return picture(std::move(canvas));
}

} // namespace

void draw_picture(const std::filesystem::path& file, const std::filesystem::path& target) {
    using Path = const std::filesystem::path&;
    static const std::map<std::string, std::function<Drawing(Path)>> pictures{
        {".wif", [](Path path) { return drawdown(read_wif(path)); }},
        {".toml", [](Path path) { return element_picture(read_cloth(path)); }},
        {".bsdf", [](Path path) { return table_picture(read_table(path)); }},
        {".gltf", frames},
        {".glb", frames}};
    if (const std::string ending = lower_extension(target); ending != ".png" && ending != ".svg")
        throw FileError("command line", "--picture", "a file that ends in .png or .svg",
                        target.string());
    const auto found = pictures.find(lower_extension(file));
    if (found == pictures.end())
        throw FileError(file.string(), "",
                        "a .wif, .toml, .bsdf, .gltf or .glb, of which there are pictures",
                        "another ending");
    found->second(file).write(target);
}

} // namespace rapport
