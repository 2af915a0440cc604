#pragma once

#include "renderer/core/params.h"
#include "renderer/scene/picture.h"

namespace rapport {

/// pbrt's Texture "imagemap": "string filename" (PNG, JPEG, TGA or BMP), "string wrap" ("repeat",
/// "black" or "clamp"), "string encoding" ("sRGB" or "linear"), "float scale", and the mapping's
/// "float uscale", "vscale", "udelta" and "vdelta". "string filter" is accepted; the lookup is
/// bilinear.
std::shared_ptr<const PictureTexture> make_imagemap(const Params& params,
                                                    const std::filesystem::path& base_dir);

} // namespace rapport
