#pragma once

#include "renderer/core/math.h"

#include <algorithm>

// Maps from the unit square to shapes, each uniform unless its name says otherwise, with the
// density of what comes out. All are continuous and keep neighbours together, so that stratified
// points stay stratified.

namespace rapport {

/// Uniform on the unit disk: concentric map (Shirley & Chiu 1997).
template <class T> Vector2<T> square_to_disk(const Vector2<T>& u) {
    const T a = 2 * u.x - 1, b = 2 * u.y - 1;
    if (a == 0 && b == 0)
        return {0, 0};
    if (std::abs(a) > std::abs(b)) {
        const T phi = T(kPi / 4) * (b / a);
        return {a * std::cos(phi), a * std::sin(phi)};
    }
    const T phi = T(kPi / 2) - T(kPi / 4) * (a / b);
    return {b * std::cos(phi), b * std::sin(phi)};
}
/// [1/area]
template <class T> constexpr T disk_pdf() { return T(1 / kPi); }

/// Unit vector about +z with density cosθ/π: the disk lifted to the hemisphere (Malley). cosθ is
/// never 0, so that the density is never 0 either.
template <class T> Vector3<T> square_to_cosine_hemisphere(const Vector2<T>& u) {
    const Vector2<T> disk = square_to_disk(u);
    const T z = safe_sqrt(1 - disk.x * disk.x - disk.y * disk.y);
    return {disk.x, disk.y, std::max(z, T(1e-6))};
}
/// [1/sr] for a direction whose z is `cos_theta`; 0 below the horizon.
template <class T> constexpr T cosine_hemisphere_pdf(T cos_theta) {
    return cos_theta > 0 ? cos_theta * T(1 / kPi) : T(0);
}

/// Uniform on the cone about +z whose half angle is α, given as 1 − cos α in (0, 2] so that a cone
/// as narrow as the sun keeps its precision; 2 is the whole sphere.
template <class T> Vector3<T> square_to_uniform_cone(const Vector2<T>& u, T one_minus_cos_alpha) {
    const T depth = u.x * one_minus_cos_alpha; // 1 - cosθ
    const T sin_theta = safe_sqrt(depth * (2 - depth));
    const T phi = T(2 * kPi) * u.y;
    return {sin_theta * std::cos(phi), sin_theta * std::sin(phi), 1 - depth};
}
/// [1/sr] inside the cone.
template <class T> constexpr T uniform_cone_pdf(T one_minus_cos_alpha) {
    return 1 / (T(2 * kPi) * one_minus_cos_alpha);
}

/// Uniform unit vector.
template <class T> Vector3<T> square_to_uniform_sphere(const Vector2<T>& u) {
    return square_to_uniform_cone(u, T(2));
}
/// [1/sr]
template <class T> constexpr T uniform_sphere_pdf() { return T(1 / (4 * kPi)); }

/// Barycentric coordinates uniform on a triangle: the square folded along its diagonal with little
/// distortion (Heitz 2019, "A Low-Distortion Map Between Triangle and Square"). The density is
/// one over the triangle's area.
template <class T> Vector3<T> square_to_triangle(const Vector2<T>& u) {
    T a = u.x / 2, b = u.y / 2;
    if (u.x < u.y)
        b = u.y - a;
    else
        a = u.x - b;
    return {a, b, std::max(T(0), 1 - a - b)};
}

} // namespace rapport
