#pragma once

#include "renderer/core/rng.h"

#include <glm/glm.hpp>

namespace rapport {

/// The numbers of one camera path: independent, or Owen-scrambled Sobol points, each consumed
/// dimension pair padded with a shuffled index of its own (Burley 2020, "Practical Hash-based Owen
/// Scrambling", JCGT 9(4)). Samples of even and of odd number are two sets of points that are
/// scrambled apart: what they differ by tells the error. A pure function of (seed, pixel, sample).
class Sampler {
  public:
    enum class Kind { independent, sobol };
    Sampler(Kind kind, uint64_t seed, uint64_t pixel, uint32_t sample);

    float next_1d();     ///< [0, 1)
    glm::vec2 next_2d(); ///< [0, 1)²
    /// Independent numbers, as many as a walk of unknown length takes; other ones at each call.
    CounterRng stream();

  private:
    Kind kind_;
    CounterRng rng_;
    uint64_t scramble_seed_;
    uint32_t reversed_sample_, dimension_ = 0;
};

} // namespace rapport
