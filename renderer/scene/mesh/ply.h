#pragma once

#include "renderer/scene/mesh/mesh.h"

#include <filesystem>

namespace rapport {

/// Reads a triangle mesh from a PLY file (Turk 1994), ASCII or binary of either byte order: vertex
/// properties x y z, optionally nx ny nz, and texture coordinates under any of the names u v, s t,
/// texture_u texture_v, texture_s texture_t; faces of three or four corners, quads cut along their
/// shorter diagonal. Other elements and properties are skipped. Weft and warp follow from the UVs;
/// normals stay empty when the file has none. FileError for anything damaged.
TriangleMesh read_ply(const std::filesystem::path& path);

} // namespace rapport
