#pragma once

#include "renderer/core/sampler.h"

#include <glm/glm.hpp>
#include <string>

namespace rapport {

/// Everything that decides how a picture is computed, beside the scene and the camera.
struct RenderSettings {
    int samples = 16;  ///< per pixel, unless an error is asked for
    double error = 0;  ///< relative noise to be reached (sample_plan.h); 0 = none is asked for
    int max_depth = 5; ///< scattering events of a path, pbrt's maxdepth
    Sampler::Kind sampler = Sampler::Kind::sobol;
    uint64_t seed = 0;
    glm::vec2 filter_radius{0.5f}; ///< of the box filter, in pixels
    std::string output;            ///< the file that the scene names
};

} // namespace rapport
