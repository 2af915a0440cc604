#pragma once

#include "renderer/scene/mesh/tessellation.h"

namespace rapport {

/// Looks for faces whose limit surface turns too far within one of the triangles that they are cut
/// into: a vertex normal lies more than 60° off the triangle's own, so that what is shaded and what
/// is met by a ray face different ways, as at the rim of a disc that is thinner than a piece is
/// long. Raises the rates round them, up to `finest`, and returns whether any rose. `mesh` has
/// positions and normals, vertex for vertex those of the tessellation.
bool refine_sharp_turns(const ControlMesh& control, const Tessellation& tessellation,
                        const TriangleMesh& mesh, const EdgeRate& finest, SideRates& rates);

} // namespace rapport
