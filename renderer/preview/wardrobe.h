#pragma once

#include "renderer/scene/scene.h"

#include <map>
#include <set>

namespace rapport {

/// The cloth that a material is, and how it lies (Material "cloth").
struct ClothChoice {
    std::filesystem::path file;
    std::string colourway;
    float rotation = 0; ///< degrees

    bool operator==(const ClothChoice&) const = default;
};

/// By the name of the material, as the model or the scene calls it.
using ClothChoices = std::map<std::string, ClothChoice>;

/// Those that a scene was built with.
ClothChoices worn_cloths(const Scene& scene);
/// Names of all materials whose surfaces have UVs, along which a cloth would lie.
std::set<std::string> wearers(const Scene& scene);

/// Factors of radiance and rotations about the vertical in degrees, relative to the scene's own
/// lights: those from all around, parallel ones, and those that stand in the scene.
struct LightSettings {
    float sky = 1, sky_rotation = 0;
    float sun = 1, sun_rotation = 0;
    float lamps = 1;

    bool operator==(const LightSettings&) const = default;
};

/// Which of these a scene has.
struct LightKinds {
    bool sky = false, sun = false, lamps = false;
};
LightKinds light_kinds(const Scene& scene);

/// `scene` in these cloths and lights. `load_table` is asked on the way; choices of names that no
/// surface bears are left out.
Scene dressed(const Scene& scene, const ClothChoices& choices, const LightSettings& lights,
              const glm::vec3& up, const LoadTable& load_table);

} // namespace rapport
