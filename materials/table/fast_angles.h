#pragma once

#include "materials/table/simd.h"

namespace rapport {

// Angles for looking up bins, T = float or Float4. The C library's last digits would cost more than
// the rest of the look-up, so these are polynomials of least largest error (Remez). Whoever
// evaluates and whoever samples call the same ones, and so see the same edges of a bin.

/// acos of `x` in [0, 1], within 1e-6 rad. √(1 − x) carries the infinite slope at 1 (Abramowitz &
/// Stegun 4.4.45).
template <class T> RAPPORT_INLINE T fast_acos(const T& x) {
    using std::sqrt;
    const T p = 1.57079566f +
                x * (-0.21454282f +
                     x * (0.08817105f + x * (-0.04592723f + x * (0.02062006f + x * -0.00491117f))));
    return sqrt(1.0f - x) * p;
}

/// Azimuth of (x, y) from +x towards +y in [0, 2π], within 2e-6 rad; 0 at the origin.
template <class T> RAPPORT_INLINE T fast_azimuth(const T& x, const T& y) {
    using std::abs, std::max, std::min;
    const T ax = abs(x), ay = abs(y);
    const T t = min(ax, ay) / max(max(ax, ay), T(1e-30f));
    const T q = t * t;
    const T p = 0.99997723f +
                q * (-0.33262283f +
                     q * (0.19354038f + q * (-0.11642648f + q * (0.05264734f + q * -0.01171913f))));
    T phi = t * p;
    phi = select(ay > ax, 1.57079633f - phi, phi);
    phi = select(x < 0.0f, 3.14159265f - phi, phi);
    return select(y < 0.0f, 6.28318531f - phi, phi);
}

} // namespace rapport
