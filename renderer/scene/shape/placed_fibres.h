#pragma once

#include "renderer/core/bands.h"
#include "renderer/core/rng.h"

#include <memory>
#include <optional>

namespace rapport {

class FibreSwatch;

/// A swatch of explicit fibres at its place in the scene, where lengths are metres.
class PlacedFibres {
  public:
    /// Throws std::invalid_argument for a placement that is more than a turn, a move and a scale
    /// common to all axes.
    PlacedFibres(std::shared_ptr<const FibreSwatch> swatch, const glm::mat4& to_world);

    struct Passage {
        glm::vec3 position, direction, normal; ///< as FibreSwatch::Passage, in world space
        Rgb weight;
        bool scattered;
    };
    std::optional<Passage> follow(const glm::vec3& position, const glm::vec3& direction,
                                  CounterRng& rng) const;
    std::optional<Passage> pass(const glm::vec3& position, const glm::vec3& direction) const;

  private:
    template <class Found> std::optional<Passage> in_world(const Found& found) const;
    glm::dvec3 to_swatch(const glm::vec3& position) const;
    glm::dvec3 turned_to_swatch(const glm::vec3& direction) const;

    std::shared_ptr<const FibreSwatch> swatch_;
    glm::dmat3 turn_;  ///< swatch → world
    glm::dvec3 place_; ///< of the swatch's centre [m]
    double scale_;     ///< metres per µm of the swatch
};

} // namespace rapport
