#include "materials/bsdf.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace rapport {

std::shared_ptr<const Bsdf> make_material(const std::string& name, const MaterialContext& context) {
    const MaterialRegistry& registry = MaterialRegistry::instance();
    const MaterialFactory* factory = registry.find(name);
    if (!factory)
        context.params.fail("type",
                            fmt::format("a material: {}", fmt::join(registry.names(), ", ")),
                            fmt::format("\"{}\"", name));
    auto material = (*factory)(context);
    context.params.check_all_used();
    return material;
}

} // namespace rapport
