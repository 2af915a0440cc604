#pragma once

#include "renderer/core/bands.h"
#include "vgsp/cloth.h"
#include "vgsp/incident_path.h"

#include <memory>
#include <optional>

namespace rapport {

/// A rectangle of a cloth as its fibres themselves, with the optics that the goniophotometer
/// measures them by: x = weft, y = warp, z = face [µm], centred on the origin with z = 0 in the
/// cloth's middle. It is a window on the endless cloth: light that comes to one of its four sides
/// leaves there, out of a cut fibre too, and light that comes in by a side starts between the
/// fibres. Constant after construction, callable from any thread.
class FibreSwatch {
  public:
    /// `size` is the width along the weft and the height along the warp [µm]. The fibres and their
    /// dyes are those that a measurement with `seed` has. FileError (at the cloth's path) for a
    /// cloth that cannot exist, a colour out of reach or an unknown colourway.
    FibreSwatch(const Cloth& cloth, const glm::dvec2& size, const std::string& colourway,
                uint64_t seed = 0);
    /// Of fibres that are there already; `optics` by their kind.
    FibreSwatch(std::shared_ptr<const kernel::FibreTracer> tracer,
                const std::vector<FibreOptics>& optics, const Bands& bands, const glm::dvec2& size);

    /// Corners of the box that holds it.
    glm::dvec3 low() const { return low_; }
    glm::dvec3 high() const { return high_; }

    /// What becomes of light, or by reciprocity of a camera path.
    struct Passage {
        glm::dvec3 position, direction; ///< where it leaves the box, and its unit direction there
        glm::dvec3 normal;              ///< of the side of the box that it leaves by, outward
        Rgb weight;                     ///< share that is left of it
        bool scattered;                 ///< it met a fibre; else it goes straight on
    };
    /// Follows light from a point on the box along unit `direction`; nothing if it is absorbed.
    /// Fresnel's choice is made by `rng`, absorption is a weight.
    std::optional<Passage> follow(const glm::dvec3& position, const glm::dvec3& direction,
                                  CounterRng& rng) const;
    /// Where light leaves that meets no fibre; nothing if it meets one.
    std::optional<Passage> pass(const glm::dvec3& position, const glm::dvec3& direction) const;

  private:
    FibreSwatch(std::shared_ptr<const kernel::FibreTracer> tracer, const Cloth& cloth,
                const glm::dvec2& size, const std::string& colourway, uint64_t seed);
    struct Exit;
    Exit exit(const glm::dvec3& position, const glm::dvec3& direction) const;
    Passage passage(const glm::dvec3& position, const glm::dvec3& direction, const Exit& exit,
                    const Rgb& weight, bool scattered) const;
    bool over_cloth(const glm::dvec3& position) const {
        return position.x >= low_.x && position.x <= high_.x && position.y >= low_.y &&
               position.y <= high_.y;
    }
    glm::dvec3 in_cloth(const glm::dvec3& position) const {
        return {position.x - low_.x, position.y - low_.y, position.z};
    }

    std::shared_ptr<const kernel::FibreTracer> tracer_;
    glm::dvec3 low_, high_;
    std::vector<std::vector<FibreMedium>> media_; ///< of each group of bands that share paths
    std::vector<Rgb> band_rgb_;
};

} // namespace rapport
