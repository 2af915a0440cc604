#pragma once

#include "renderer/scene/mesh/mesh.h"

namespace rapport {

/// UVs in metres for a mesh without: each triangle is projected along the axis nearest to its
/// normal. On sides v runs up (+y), so that the warp hangs vertically round the whole of a garment;
/// on what faces up or down it runs towards −z. The map is nowhere mirrored; between pieces that
/// face along different axes it has seams.
void add_auto_uvs(IndexedMesh& mesh);

} // namespace rapport
