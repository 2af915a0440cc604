#pragma once

#include "materials/table/bsdf_table.h"
#include "renderer/app/drawing.h"

namespace rapport {

/// Where light goes that comes on the front side at three angles in the plane of the weft, as
/// hemispheres, reflected above and transmitted below; polar plots of it in the planes of the weft
/// and of the warp; and the error ε of each incident direction. Of a partial table, the directions
/// that are nearest to these.
Drawing table_picture(const BsdfTable& table);

} // namespace rapport
