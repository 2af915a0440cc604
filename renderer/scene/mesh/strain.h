#pragma once

#include "renderer/scene/mesh/mesh.h"

namespace rapport {

/// How a cloth that was cut flat is strained where it lies on a surface: the ranges of 90 % of the
/// area.
struct Strain {
    struct Range {
        double low, high;
    };
    Range weft, warp; ///< lengths on the surface over those in the cloth
    Range shear;      ///< by which the angle from weft to warp falls short of a right one [rad]
};

/// Of the surface over its UVs, a unit of which is `metres_per_uv` of the cloth: from weft and warp
/// of about 10⁴ triangles, evenly drawn from a mesh that has both.
Strain strain(const TriangleMesh& mesh, double metres_per_uv);

} // namespace rapport
