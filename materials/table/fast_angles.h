#pragma once

#include <algorithm>
#include <cmath>

namespace rapport {

// Angles for looking up bins. The C library's last digits would cost more than the rest of the
// look-up, so these are polynomials: of least largest error (Remez), the sine Taylor's. Whoever
// evaluates and whoever samples call the same ones, and so see the same edges of a bin.

/// acos of `x` in [0, 1], within 1e-6 rad. √(1 − x) carries the infinite slope at 1 (Abramowitz &
/// Stegun 4.4.45).
inline float fast_acos(float x) {
    const float p =
        1.57079566f +
        x * (-0.21454282f +
             x * (0.08817105f + x * (-0.04592723f + x * (0.02062006f + x * -0.00491117f))));
    return std::sqrt(1.0f - x) * p;
}

/// atan of `t` in [0, 1], within 2e-6 rad.
inline float fast_atan(float t) {
    const float q = t * t;
    return t *
           (0.99997723f +
            q * (-0.33262283f +
                 q * (0.19354038f + q * (-0.11642648f + q * (0.05264734f + q * -0.01171913f)))));
}

/// atan of ay/ax for ax, ay ≥ 0, in [0, π/2]; 0 at the origin.
inline float fast_first_quadrant(float ax, float ay) {
    const float angle = fast_atan(std::min(ax, ay) / std::max(std::max(ax, ay), 1e-30f));
    return ay > ax ? 1.57079633f - angle : angle;
}

/// Azimuth of (x, y) from +x towards +y in [0, 2π], within 2e-6 rad; 0 at the origin.
inline float fast_azimuth(float x, float y) {
    const float angle = fast_first_quadrant(std::abs(x), std::abs(y));
    const float half = x < 0 ? 3.14159265f - angle : angle;
    return y < 0 ? 6.28318531f - half : half;
}

/// atan2(x, z) over π/2, for z ≥ 0: in [−1, 1], within 2e-6.
inline float fast_quarter_turns(float x, float z) {
    return std::copysign(fast_first_quadrant(z, std::abs(x)) * 0.636619772f, x);
}

/// sin(t·π/2) for `t` in [−1, 1], within 2e-7.
inline float fast_sine(float t) {
    const float q = t * t;
    return t * (1.57079633f +
                q * (-0.645964098f +
                     q * (0.0796926262f +
                          q * (-0.00468175414f + q * (0.000160441185f + q * -3.59884324e-6f)))));
}

} // namespace rapport
