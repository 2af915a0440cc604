#pragma once

#include "renderer/core/math.h"

#include <algorithm>

// The equal-area octahedral map between the unit square and the sphere (Clarberg 2008, "Fast
// Equal-Area Mapping of the (Hemi)Sphere using SIMD"), in the orientation of pbrt-v4's square
// image lights: the centre of the square is +z, its corners are −z, and its x and y follow the
// direction's. A density per unit area of the square is 4π times that per steradian.

namespace rapport {

/// Unit vector of a point of [0, 1]².
template <class T> Vector3<T> octahedral_to_sphere(const Vector2<T>& p) {
    const T u = 2 * p.x - 1, v = 2 * p.y - 1;
    const T abs_u = std::abs(u), abs_v = std::abs(v);
    const T above = 1 - (abs_u + abs_v); // signed distance from the square's inner diamond, z = 0
    const T r = 1 - std::abs(above);
    const T phi = T(kPi / 4) * (r == 0 ? T(1) : (abs_v - abs_u) / r + 1); // within the octant
    const T sin_theta = r * safe_sqrt(2 - r * r);
    return {std::copysign(sin_theta * std::cos(phi), u),
            std::copysign(sin_theta * std::sin(phi), v), std::copysign(1 - r * r, above)};
}

/// Point of [0, 1]² of a unit vector.
template <class T> Vector2<T> sphere_to_octahedral(const Vector3<T>& w) {
    // r² = 1 − |z|, in a form that does not cancel near the poles.
    const T r = std::sqrt((w.x * w.x + w.y * w.y) / (1 + std::abs(w.z)));
    const T turn = w.x == 0 && w.y == 0
                       ? T(0)
                       : std::atan2(std::abs(w.y), std::abs(w.x)) * T(2 / kPi); // [0, 1]
    T v = std::min(r, T(1)) * turn;
    T u = std::min(r, T(1)) - v;
    if (w.z < 0) { // fold the octant over the diamond's edge
        const T folded = 1 - v;
        v = 1 - u;
        u = folded;
    }
    return {(std::copysign(u, w.x) + 1) / 2, (std::copysign(v, w.y) + 1) / 2};
}

} // namespace rapport
