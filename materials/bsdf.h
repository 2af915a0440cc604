#pragma once

#include "renderer/core/bands.h"
#include "renderer/core/math.h"
#include "renderer/core/params.h"
#include "renderer/core/registry.h"

#include <filesystem>
#include <functional>
#include <limits>
#include <memory>
#include <optional>

namespace rapport {

class TableBsdf;

// The local frame is right-handed: x = weft (+u), y = warp (+v), z = normal of the face side.
// `eye` and `light` are unit vectors that point away from the surface, towards where the path came
// from and where the light is. A camera path needs f(light → eye)·|cosθ_light|; that is what
// `eval` returns. All quantities are linear RGB.

struct BsdfValue {
    Rgb value; ///< f·|cosθ_light|
    float pdf; ///< as of `Bsdf::pdf`
};

/// The `pdf` of a sample in a direction that has no density, as a mirror's.
inline constexpr float kMirror = std::numeric_limits<float>::infinity();

struct BsdfSample {
    glm::vec3 light; ///< sampled direction
    Rgb weight;      ///< f·|cosθ_light| / pdf
    float pdf;       ///< [1/sr], or kMirror; of scattering only, see `unscattered`
};

/// Of the light from one direction.
struct BsdfShares {
    Rgb unscattered, scattered;
};

/// How light scatters where it meets a surface. Constant after construction.
class Bsdf {
  public:
    virtual ~Bsdf() = default;

    /// f·|cosθ_light| for both sides of the surface, without the unscattered beam.
    virtual Rgb eval(const glm::vec3& eye, const glm::vec3& light) const = 0;
    /// Density of `sample` over solid angle [1/sr]; integrates over the sphere to the chance that
    /// `sample` gives a direction: 1, or less where light is lost, and 0 for mirrors.
    virtual float pdf(const glm::vec3& eye, const glm::vec3& light) const = 0;
    /// `eval` and `pdf` of one pair of directions, where a material can share the work.
    virtual BsdfValue eval_and_pdf(const glm::vec3& eye, const glm::vec3& light) const {
        return {eval(eye, light), pdf(eye, light)};
    }
    /// A direction of density `pdf`; nothing if the light is lost. `choice` and `u` are uniform in
    /// [0, 1).
    virtual std::optional<BsdfSample> sample(const glm::vec3& eye, float choice,
                                             const glm::vec2& u) const = 0;
    /// Share of light that passes straight through without an event, from −eye to eye: a null
    /// interaction, never part of the three above. Same in both directions of travel.
    virtual Rgb unscattered(const glm::vec3& eye) const {
        (void)eye;
        return Rgb(0);
    }
    /// Share of the light from `eye` that is scattered, for the albedo image and for how often
    /// paths are; an estimate will do, 0 only where nothing is.
    virtual Rgb albedo(const glm::vec3& eye) const = 0;
    /// `unscattered` and `albedo` of one direction, where a material can share the work.
    virtual BsdfShares shares(const glm::vec3& eye) const {
        return {unscattered(eye), albedo(eye)};
    }
};

/// A measured table by file name, `.bsdf` or a `.toml` measured on the way, in a colourway of the
/// cloth (empty: its own dyes).
using LoadTable = std::function<std::shared_ptr<const TableBsdf>(const std::filesystem::path& path,
                                                                 const std::string& colourway)>;

/// What a material is made from.
struct MaterialContext {
    const Params& params;
    std::filesystem::path base_dir; ///< file names are relative to it
    LoadTable load_table;
};

using MaterialFactory = std::function<std::shared_ptr<const Bsdf>(const MaterialContext&)>;
using MaterialRegistry = Registry<MaterialFactory>;
/// A new material is one file with, at its end,
///     const Registered<MaterialFactory> registered("name", make_name);
/// Makes the material `name`, or throws a FileError that lists the names there are. Parameters that
/// neither the material nor anyone before has asked for are FileErrors too.
std::shared_ptr<const Bsdf> make_material(const std::string& name, const MaterialContext& context);

} // namespace rapport
