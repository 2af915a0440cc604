#pragma once

#include "renderer/core/sampler.h"
#include "renderer/scene/scene.h"

#include <optional>
#include <vector>

namespace rapport {

struct PathResult {
    Rgb radiance{0};
    Rgb albedo{0}; ///< of the first vertex; of explicit fibres, what this path saw of them
    /// What the path would have scattered on where `max_depth` ended it: its weight times the
    /// albedo there, in the mean over the channels; of explicit fibres the weight alone.
    float cut = 0;
    /// Rays through the scene: to each vertex, and to a light, through however many cloths it sees
    /// that; not those among explicit fibres.
    uint32_t rays = 0;
};

/// What a path met, and what its light counted on the way there.
struct PathVertex {
    SurfacePoint point;
    Rgb throughput;
};

/// Follows one camera path against the light.
///
/// At each vertex, light reaches the eye by three ways that share nothing: emission; scattering,
/// estimated by one direction of the lights, picked from some (Talbot et al. 2005), and by one BSDF
/// sample that are weighted against each other (Veach 1997, balance heuristic); and the unscattered
/// beam. The last is a null interaction: the path goes straight on and the vertex leaves no trace
/// in it, so that an emitter behind cloth is weighted by the densities at the last scattering
/// vertex, just as a shadow ray weights it that goes through the same cloth (Scene::transmittance).
///
/// `max_depth` counts scattering events, as in pbrt: 0 shows emission only, 1 adds direct light.
/// `point` is what `ray` meets, which is traced in packets. The vertices are told to `vertices`, if
/// there is one.
PathResult trace_path(const Scene& scene, kernel::Ray ray, std::optional<SurfacePoint> point,
                      Sampler& sampler, std::vector<PathVertex>* vertices = nullptr);

} // namespace rapport
