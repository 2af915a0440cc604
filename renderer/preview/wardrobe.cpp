#include "renderer/preview/wardrobe.h"

#include "renderer/preview/adjusted_light.h"

#include <algorithm>
#include <glm/gtc/matrix_transform.hpp>

namespace rapport {
namespace {

std::shared_ptr<const Bsdf> cloth(const std::string& name, const ClothChoice& choice,
                                  const LoadTable& load_table) {
    Params params(choice.file.string(), "cloth " + name, 0);
    params.add({"string", "filename", {}, {choice.file.string()}, 0, 0});
    params.add({"string", "colourway", {}, {choice.colourway}, 0, 0});
    params.add({"float", "rotation", {choice.rotation}, {}, 0, 0});
    return make_material("cloth", {params, "", load_table});
}

bool can_be_dressed(const Surface& surface) {
    return surface.description && !surface.description->name.empty() && !surface.mesh->uvs.empty();
}

glm::mat3 about(const glm::vec3& axis, float angle_degrees) {
    return glm::mat3(glm::rotate(glm::mat4(1), radians(angle_degrees), axis));
}

} // namespace

ClothChoices worn_cloths(const Scene& scene) {
    ClothChoices worn;
    for (const Surface& surface : scene.surfaces()) {
        if (!surface.description || surface.description->type != "cloth")
            continue;
        const MaterialDescription& material = *surface.description;
        worn[material.name] = {std::filesystem::weakly_canonical(
                                   material.base_dir / material.params.get_string("filename", "")),
                               material.params.get_string("colourway", ""),
                               material.params.get_float("rotation", 0)};
    }
    return worn;
}

std::set<std::string> wearers(const Scene& scene) {
    std::set<std::string> names;
    for (const Surface& surface : scene.surfaces())
        if (can_be_dressed(surface))
            names.insert(surface.description->name);
    return names;
}

LightKinds light_kinds(const Scene& scene) {
    LightKinds kinds;
    for (const auto& light : scene.lights())
        (light->has_place() ? kinds.lamps : light->is_delta() ? kinds.sun : kinds.sky) = true;
    for (const Surface& surface : scene.surfaces())
        kinds.lamps |= surface.emission != Rgb(0);
    return kinds;
}

Scene dressed(const Scene& scene, const ClothChoices& choices, const LightSettings& settings,
              const glm::vec3& up, const LoadTable& load_table) {
    std::map<std::string, std::shared_ptr<const Bsdf>> cloths;
    std::vector<Surface> surfaces = scene.surfaces();
    for (Surface& surface : surfaces) {
        surface.emission *= settings.lamps;
        if (!can_be_dressed(surface))
            continue;
        const std::string& name = surface.description->name;
        const auto choice = choices.find(name);
        if (choice == choices.end())
            continue;
        auto& made = cloths[name];
        if (!made)
            made = cloth(name, choice->second, load_table);
        surface.material = made;
        surface.print = {};
    }
    std::vector<std::shared_ptr<Light>> lights;
    const auto add = [&](const std::shared_ptr<Light>& light, float scale, float rotation) {
        lights.push_back(std::make_shared<AdjustedLight>(light, scale, about(up, rotation)));
    };
    for (const auto& light : scene.lights())
        if (light->has_place())
            add(light, settings.lamps, 0);
        else if (light->is_delta())
            add(light, settings.sun, settings.sun_rotation);
        else
            add(light, settings.sky, settings.sky_rotation);
    return Scene(scene, std::move(surfaces), std::move(lights));
}

} // namespace rapport
