#pragma once

#include "renderer/scene/mesh/control_mesh.h"

namespace rapport {

/// Border vertices that lie on another piece's border edge, between its ends: where the pieces
/// touch without being joined, and would part when each is subdivided for itself. Such an edge, the
/// edges that run along it, and their ends are marked `straight` and `pinned` in `control.cut`, so
/// that all stay on the line on which they touch. A vertex lies on an edge if it is nearer to it
/// than a thousandth of the edge's length. Returns how many vertices there are.
size_t hold_t_junctions(ControlMesh& control);

} // namespace rapport
