#include "renderer/scene/shape/shape.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace rapport {

std::vector<ShapePart> make_shape(const std::string& name, const ShapeContext& context) {
    const ShapeRegistry& registry = ShapeRegistry::instance();
    const ShapeFactory* factory = registry.find(name);
    if (!factory)
        context.params.fail("", fmt::format("a shape: {}", fmt::join(registry.names(), ", ")),
                            fmt::format("\"{}\"", name));
    auto parts = (*factory)(context);
    context.params.check_all_used();
    return parts;
}

} // namespace rapport
