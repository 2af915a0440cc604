#pragma once

#include "renderer/core/image.h"
#include "renderer/scene/scene.h"

#include <functional>

namespace rapport {

/// Renders with next-event estimation, MIS (balance heuristic), Russian roulette and null
/// interactions for the unscattered beam. Channels: R, G, B, albedo.{R,G,B}, N.{X,Y,Z},
/// warp.{X,Y,Z}, variance.{R,G,B} (of the pixel's mean), Z. The same seed gives the same pixels,
/// whatever the number of threads. `progress` is told the finished share, [0, 1].
Image render(const Scene& scene, const std::function<void(double)>& progress = {});

} // namespace rapport
