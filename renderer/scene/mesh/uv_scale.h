#pragma once

#include "renderer/scene/mesh/mesh.h"

namespace rapport {

/// How many metres of surface a unit of the UVs covers: the square root of area over UV area, its
/// median over the surface. 1 for UVs in metres, 0.001 for millimetres; 0 if no triangle has both.
double metres_per_uv(const IndexedMesh& mesh);

} // namespace rapport
