#include "renderer/scene/light/light.h"

#include "renderer/core/error.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace rapport {

std::shared_ptr<Light> make_light(const std::string& name, const LightContext& context) {
    const LightRegistry& registry = LightRegistry::instance();
    const LightFactory* factory = registry.find(name);
    if (!factory)
        context.params.fail("", fmt::format("a light: {}", fmt::join(registry.names(), ", ")),
                            fmt::format("\"{}\"", name));
    auto light = (*factory)(context);
    context.params.check_all_used();
    return light;
}

float light_scale(const Params& params) {
    const float scale = params.get_float("scale", 1);
    if (!(scale >= 0))
        params.fail("scale", "0 or more", fmt::format("{}", scale));
    return scale;
}

Rgb light_color(const Params& params, const char* name) {
    const Rgb color = params.get_rgb(name, Rgb(1));
    if (glm::any(glm::lessThan(color, Rgb(0))))
        params.fail(name, "numbers that are 0 or more",
                    fmt::format("[{} {} {}]", color.r, color.g, color.b));
    return color * light_scale(params);
}

Rgb light_radiance(const Params& params) { return light_color(params, "L"); }

} // namespace rapport
