#pragma once

#include "materials/table/simd.h"

#include <cstdint>

namespace rapport {

/// Unit vectors in the frame of the cloth; T = float or Float4.
template <class T> struct Direction { T x, y, z; };

/// A direction that moved, and the solid angle about it over that about where it came from.
template <class T> struct MovedDirection {
    Direction<T> direction;
    T stretch;
};

/// Moves the exits of light with its incidence, so that highlights stand still in between.
///
/// A fibre sends what it scatters onto a cone about its axis, mirrored at the plane across it:
/// sin θ_out = −sin θ_in, angles to that plane (Marschner et al. 2003). With warp along y and weft
/// along x, yarns that lie flat thus light up on y = −y_in and x = −x_in, in reflection and in
/// transmission. `along_warp` slides y on [−1, 1], linearly to either side of the highlight, from
/// the highlight of incidence `from` to that of `to`, and keeps the angle round the warp; as (y,
/// angle round y) is an equal-area chart of the sphere, the slope of the slide is all that the
/// solid angle changes by. It maps each hemisphere onto itself, one to one, so that what is moved
/// keeps its energy; its inverse is itself with `from` and `to` exchanged. For the weft, the same
/// along x.
template <class T>
RAPPORT_INLINE MovedDirection<T> along_warp(const Direction<T>& w, const Direction<T>& from,
                                            const Direction<T>& to) {
    using std::max, std::min, std::sqrt;
    constexpr float kEnd = 0.999999f; // off ±1, where a side has no length
    const T start = max(T(-kEnd), min(T(kEnd), -from.y));
    const T end = max(T(-kEnd), min(T(kEnd), -to.y));
    const T side = select(w.y < start, T(1.0f), T(-1.0f)); // on the side of y = −1, of y = 1
    const T slope = (1.0f + side * end) / (1.0f + side * start);
    const T y = side * ((1.0f + side * w.y) * slope - 1.0f);
    const T turn =
        sqrt(max((1.0f - y) * (1.0f + y), T(0.0f)) / max(w.x * w.x + w.z * w.z, T(1e-30f)));
    return {{w.x * turn, y, w.z * turn}, slope};
}

template <class T>
RAPPORT_INLINE MovedDirection<T> along_weft(const Direction<T>& w, const Direction<T>& from,
                                            const Direction<T>& to) {
    const auto swapped = [](const Direction<T>& d) { return Direction<T>{d.y, d.x, d.z}; };
    const MovedDirection<T> moved = along_warp(swapped(w), swapped(from), swapped(to));
    return {swapped(moved.direction), moved.stretch};
}

/// The yarns that a distribution is moved with.
enum class YarnSystem : uint8_t { warp, weft };

template <class T>
RAPPORT_INLINE MovedDirection<T> along(YarnSystem yarns, const Direction<T>& w,
                                       const Direction<T>& from, const Direction<T>& to) {
    return yarns == YarnSystem::warp ? along_warp(w, from, to) : along_weft(w, from, to);
}

} // namespace rapport
