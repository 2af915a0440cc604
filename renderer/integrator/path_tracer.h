#pragma once

#include "renderer/core/image.h"
#include "renderer/scene/scene.h"

#include <functional>

namespace rapport {

/// Renders with next-event estimation, MIS (balance heuristic), Russian roulette and null
/// interactions for the unscattered beam. The same seed gives the same pixels, whatever the number
/// of threads.
///
/// Channels: R, G, B radiance; at the first surface that a ray meets, albedo.{R,G,B} and the unit
/// shading normal N.{X,Y,Z} and warp direction warp.{X,Y,Z} of the face side, in world space, as
/// means over the pixel (0 for samples that meet nothing); Z, the mean distance along the viewing
/// direction of the samples that meet something (0 if none do); and, from two samples up,
/// variance.{R,G,B}: that of the pixel's mean, estimated as if samples were independent, hence from
/// above for Sobol points.
///
/// `progress` is told the finished share, (0, 1], from any thread but never from two at a time.
/// Throws std::runtime_error naming the pixel where a radiance is not finite.
Image render(const Scene& scene, const std::function<void(double)>& progress = {});

} // namespace rapport
