#pragma once

#include "renderer/core/image.h"
#include "renderer/scene/camera.h"

namespace rapport {

/// A picture of the warp: noise smeared along the warp direction as it is seen (line integral
/// convolution; Cabral & Leedom 1993), lighter where the surface faces the camera, bluish on the
/// back of the cloth, black where there is nothing. Made from the channels N, warp and Z of a
/// rendered picture (Film::image).
Image warp_streaks(const Image& rendered, const Camera& camera);

} // namespace rapport
