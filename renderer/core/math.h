#pragma once

#include <cmath>
#include <glm/glm.hpp>
#include <numbers>

// Scalars, directions and frames. Vectors are GLM's: float in the renderer, double in the
// goniophotometer, so the functions here are templates over the scalar.

namespace rapport {

inline constexpr double kPi = std::numbers::pi;

template <class T> constexpr T radians(T degrees) { return degrees * T(kPi / 180); }
template <class T> constexpr T degrees(T radians) { return radians * T(180 / kPi); }

template <class T> using Vector3 = glm::vec<3, T, glm::defaultp>;
template <class T> using Vector2 = glm::vec<2, T, glm::defaultp>;

template <class T> constexpr T square(T x) { return x * x; }

/// sqrt that forgives a negative argument left by rounding.
template <class T> T safe_sqrt(T x) { return x > 0 ? std::sqrt(x) : T(0); }

/// Unit vector at polar angle `theta` from +z and azimuth `phi` from +x towards +y (radians).
template <class T> Vector3<T> spherical_direction(T theta, T phi) {
    const T s = std::sin(theta);
    return {s * std::cos(phi), s * std::sin(phi), std::cos(theta)};
}

/// Azimuth of `w` from +x towards +y, in [0, 2π); 0 at the pole.
template <class T> T azimuth(const Vector3<T>& w) {
    const T phi = std::atan2(w.y, w.x);
    const T wrapped = phi < 0 ? phi + T(2 * kPi) : phi;
    return wrapped < T(2 * kPi) ? wrapped : T(0); // -epsilon + 2π rounds to 2π
}

/// An orthonormal, right-handed basis: x × y = z.
template <class T> struct BasicFrame {
    Vector3<T> x{1, 0, 0}, y{0, 1, 0}, z{0, 0, 1};

    Vector3<T> to_local(const Vector3<T>& w) const {
        return {glm::dot(w, x), glm::dot(w, y), glm::dot(w, z)};
    }
    Vector3<T> to_world(const Vector3<T>& w) const { return w.x * x + w.y * y + w.z * z; }

    /// Any frame about the unit vector `z`, without a branch that loses precision
    /// (Duff et al. 2017, "Building an Orthonormal Basis, Revisited").
    static BasicFrame about(const Vector3<T>& z) {
        const T sign = std::copysign(T(1), z.z);
        const T a = -1 / (sign + z.z);
        const T b = z.x * z.y * a;
        return {
            {1 + sign * z.x * z.x * a, sign * b, -sign * z.x}, {b, sign + z.y * z.y * a, -z.y}, z};
    }
};
using Frame = BasicFrame<float>;

} // namespace rapport
