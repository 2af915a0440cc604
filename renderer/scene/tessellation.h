#pragma once

#include "renderer/scene/manifold.h"

#include <limits>

namespace rapport {

/// How triangles, each cut into level² smaller ones, share their vertices: those on a common side
/// are one, but where the UVs differ on the two sides of a seam there is one for each.
struct Tessellation {
    struct Vertex {
        uint32_t triangle; ///< the first that has it, and evaluates it
        /// Parameters (s, t) · level in that triangle.
        uint16_t s, t;
        /// The vertex whose position and normal it shares, itself except on the far side of a seam.
        uint32_t twin;
    };
    std::vector<Vertex> vertices;      ///< those of one triangle together, triangles in order
    std::vector<uint32_t> first;       ///< per triangle: its first vertex; and the end
    std::vector<glm::uvec3> triangles; ///< level² per triangle, in order
};

inline constexpr int kMaxLevel = std::numeric_limits<uint16_t>::max();

/// `uv_index` may be empty; `level` is in [1, kMaxLevel]. All vertices must fit 32-bit numbers.
Tessellation tessellate(const std::vector<glm::uvec3>& triangles,
                        const std::vector<glm::uvec3>& uv_index, int level);

} // namespace rapport
