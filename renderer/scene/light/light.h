#pragma once

#include "renderer/core/bands.h"
#include "renderer/core/math.h"
#include "renderer/core/params.h"
#include "renderer/core/registry.h"

#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace rapport {

struct LightSample {
    glm::vec3 direction; ///< unit, from the surface towards the light
    float distance;      ///< infinity for lights at infinity
    Rgb radiance;        ///< arriving
    float pdf;           ///< [1/sr]; ignored when `delta`
    bool delta;          ///< the direction has no density (distant light): no MIS
};

struct EscapedLight {
    Rgb radiance;
    float pdf; ///< [1/sr] with which `Light::sample` picks the direction
};

/// Something that shines. Constant after `prepare`.
class Light {
  public:
    virtual ~Light() = default;
    /// Told once what the scene spans, before rendering.
    virtual void prepare(const glm::vec3& scene_centre, float scene_radius) {
        (void)scene_centre, (void)scene_radius;
    }
    virtual std::optional<LightSample> sample(const glm::vec3& from, const glm::vec2& u) const = 0;
    /// Of a ray that leaves the scene in unit `direction`; nothing for lights with a place.
    virtual EscapedLight escaped(const glm::vec3& direction) const {
        (void)direction;
        return {Rgb(0), 0};
    }
    /// Emitted power, up to a common factor, by which lights are chosen to be sampled; 0 for one
    /// that is left to rays that happen to meet it.
    virtual float power() const = 0;
    /// Whether it is seen from a single direction, which no path meets that is not aimed at it.
    virtual bool is_delta() const { return false; }
    /// Whether it stands in the scene; else it is infinitely far.
    virtual bool has_place() const { return false; }
};

struct LightContext {
    const Params& params;
    std::filesystem::path base_dir;
    glm::mat4 to_world;
    std::vector<std::string>* warnings = nullptr; ///< told what was mended, if anybody listens
};
using LightFactory = std::function<std::shared_ptr<Light>(const LightContext&)>;
using LightRegistry = Registry<LightFactory>;
/// A new light is one file with, at its end,
///     const Registered<LightFactory> registered("name", make_name);
/// Makes the light `name`, or throws a FileError that lists the names there are, or the parameters
/// where one is not known.
std::shared_ptr<Light> make_light(const std::string& name, const LightContext& context);

/// The "rgb" `name` (default 1) times "float scale" (default 1), checked to be no less than 0.
Rgb light_color(const Params& params, const char* name);
/// "rgb L" (default 1) times "float scale" (default 1), checked to be no less than 0.
Rgb light_radiance(const Params& params);
/// "float scale", no less than 0; default 1.
float light_scale(const Params& params);

} // namespace rapport
