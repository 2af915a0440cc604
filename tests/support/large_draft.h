#pragma once

#include "tests/support/scattering.h"
#include "vgsp/weave.h"

namespace rapport::tests {

/// A draft that repeats nowhere: each end passes under one pick of twelve, at places that a
/// generator scatters.
inline Draft scattered_draft(int size) {
    Draft draft = tiled(named_weave("plain"), size, size);
    CounterRng rng(1, Purpose::test, 0, 0);
    for (int pick = 0; pick < size; ++pick)
        for (int end = 0; end < size; ++end)
            draft.set_up(end, pick, rng.uniform() > 1.0 / 12);
    return draft;
}

/// Such a draft in yarns of one smooth fibre, so loosely woven that they turn little.
inline Cloth monofilament_cloth(int size) {
    YarnSpec yarn = loose_yarn(30, 28);
    yarn.fibres = 1;
    return cloth_of(scattered_draft(size), yarn, yarn, 25, 25);
}

/// What measuring the element should take [bytes].
inline double promised_memory(const MicroElement& element) {
    const auto segments = static_cast<double>(element.segments);
    return kernel::FibreTracer::memory(segments, element.fibres.cell, element.thickness_um) +
           segments * sizeof(glm::dvec3);
}

} // namespace rapport::tests
