#include "renderer/scene/pbrt/pbrt_options.h"

#include "renderer/core/error.h"

#include <algorithm>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <vector>

namespace rapport {
namespace {

using Names = std::vector<std::string_view>;

/// One of `valid`, or a FileError at `name` (at the directive, if that is its type).
void require_one_of(const Params& params, const std::string& name, const std::string& value,
                    const Names& valid) {
    if (std::find(valid.begin(), valid.end(), value) == valid.end())
        params.fail(name, fmt::format("\"{}\"", fmt::join(valid, "\" or \"")), '"' + value + '"');
}

int positive_int(const Params& params, const std::string& name, int fallback, int largest) {
    const int value = params.get_int(name, fallback);
    if (value < 1 || value > largest)
        params.fail(name, fmt::format("a number from 1 to {}", largest), std::to_string(value));
    return value;
}

/// Parameters that change how pbrt computes, never what the picture converges to.
void accept_string(const Params& params, const std::string& name, const Names& valid) {
    require_one_of(params, name, params.get_string(name, valid.front()), valid);
}

} // namespace

void read_camera(const std::string& type, const Params& params, SceneDescription& scene) {
    require_one_of(params, "", type, {"perspective", "orthographic"});
    Camera& camera = scene.camera;
    if (type == "perspective") {
        camera.kind = Camera::Kind::perspective;
        camera.fov_degrees = params.get_float("fov", 90);
        if (!(camera.fov_degrees > 0 && camera.fov_degrees < 180))
            params.fail("fov", "an angle between 0 and 180 degrees",
                        fmt::format("{}", camera.fov_degrees));
    } else {
        camera.kind = Camera::Kind::orthographic;
    }
    if (params.has("screenwindow")) {
        const std::vector<float> window = params.get_floats("screenwindow");
        if (window.size() != 4 || !(window[0] < window[1]) || !(window[2] < window[3]))
            params.fail("screenwindow", "x0 x1 y0 y1 with x0 < x1 and y0 < y1",
                        fmt::format("[{}]", fmt::join(window, " ")));
        camera.screen_window = {window[0], window[1], window[2], window[3]};
    }
}

void read_film(const std::string& type, const Params& params, SceneDescription& scene) {
    require_one_of(params, "", type, {"rgb"});
    constexpr int kLargest = 1 << 15;
    scene.camera.resolution = {positive_int(params, "xresolution", 1280, kLargest),
                               positive_int(params, "yresolution", 720, kLargest)};
    scene.settings.output = params.get_string("filename", "pbrt.exr");
    params.get_float("diagonal", 35);  // of the sensor, for lenses only
    params.get_bool("savefp16", true); // ours always saves 32 bits
}

void read_sampler(const std::string& type, const Params& params, SceneDescription& scene) {
    require_one_of(params, "", type, {"independent", "sobol", "paddedsobol", "zsobol"});
    RenderSettings& settings = scene.settings;
    settings.sampler = type == "independent" ? Sampler::Kind::independent : Sampler::Kind::sobol;
    settings.samples =
        positive_int(params, "pixelsamples", type == "independent" ? 4 : 16, 1 << 24);
    settings.seed = static_cast<uint64_t>(params.get_int("seed", 0));
    if (type != "independent")
        accept_string(params, "randomization", {"fastowen", "owen"});
}

void read_filter(const std::string& type, const Params& params, SceneDescription& scene) {
    require_one_of(params, "", type, {"box"});
    glm::vec2& radius = scene.settings.filter_radius;
    radius = {params.get_float("xradius", 0.5f), params.get_float("yradius", 0.5f)};
    for (const auto& [name, value] : {std::pair{"xradius", radius.x}, {"yradius", radius.y}})
        if (!(value > 0))
            params.fail(name, "a radius above 0 pixels", fmt::format("{}", value));
}

void read_integrator(const std::string& type, const Params& params, SceneDescription& scene) {
    require_one_of(params, "", type, {"path"});
    scene.settings.max_depth = params.get_int("maxdepth", 5);
    if (scene.settings.max_depth < 0)
        params.fail("maxdepth", "0 or more", std::to_string(scene.settings.max_depth));
    accept_string(params, "lightsampler", {"bvh", "power", "uniform"});
    if (params.get_bool("regularize", false))
        params.fail("regularize", "false: light is not blurred to speed up convergence", "true");
}

void read_color_space(const std::string& type, const Params& params, SceneDescription&) {
    require_one_of(params, "", type, {"srgb"});
}

} // namespace rapport
