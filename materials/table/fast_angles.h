#pragma once

#include "materials/table/float4.h"

#include <glm/glm.hpp>

namespace rapport {

// Angles for looking up bins. The C library's last digits would cost more than the rest of the
// look-up, so these are polynomials: of least largest error (Remez), the sine Taylor's. Whoever
// evaluates and whoever samples call the same ones, and so see the same edges of a bin.

namespace fast_angles {

constexpr float kQuarter = 1.57079633f, kHalf = 3.14159265f, kWhole = 6.28318531f; // of a turn
/// Of atan t/t in t², t in [0, 1], and of acos x/√(1 − x) in x, x in [0, 1]: √(1 − x) carries the
/// infinite slope at 1 (Abramowitz & Stegun 4.4.45).
constexpr float kAtan[] = {0.99997723f,  -0.33262283f, 0.19354038f,
                           -0.11642648f, 0.05264734f,  -0.01171913f};
constexpr float kAcos[] = {1.57079566f,  -0.21454282f, 0.08817105f,
                           -0.04592723f, 0.02062006f,  -0.00491117f};
/// Of sin(t·π/2)/t in t².
constexpr float kSine[] = {1.57079633f,     -0.645964098f,   0.0796926262f,
                           -0.00468175414f, 0.000160441185f, -3.59884324e-6f};

/// By Estrin's scheme: half as long a wait as Horner's.
template <class C> Float4 polynomial(const C (&c)[6], Float4 x) {
    const Float4 square = x * x;
    return (c[0] + c[1] * x) + square * ((c[2] + c[3] * x) + square * (c[4] + c[5] * x));
}

/// atan2(over, under) of numbers ≥ 0, with the polynomials `c` of the lanes. Where `cosine` is not
/// 0 both must be, and it is acos of that.
template <class C>
Float4 first_quadrant(Float4 over, Float4 under, const C (&c)[6], Float4 cosine, Float4 sine) {
    const Float4 t = min4(over, under) / max4(max4(over, under), four(1e-30f));
    const Float4 angle = (t + sine) * polynomial(c, t * t + cosine);
    return over > under ? kQuarter - angle : angle;
}

} // namespace fast_angles

/// sin(t·π/2) of each `t` in [−1, 1], within 2e-7.
inline Float4 fast_sine(Float4 t) { return t * fast_angles::polynomial(fast_angles::kSine, t * t); }

/// Three angles in one: of an eye (x, y, z, 0), z ≥ 0, its θ from the normal, [0, π/2], within
/// 1e-6, and its φ from +x towards +y, [0, 2π], within 2e-6 and 0 at the pole; of a light at
/// `across` and `height` its quarter turns, atan2(across, |height|) over π/2, in [−1, 1], within
/// 2e-6.
inline Float4 fast_angles_of(Float4 eye, float across, float height) {
    using namespace fast_angles;
    const auto c = [](int i) { return Float4{kAcos[i], kAtan[i], kAtan[i], kAtan[i]}; };
    const Float4 polynomials[] = {c(0), c(1), c(2), c(3), c(4), c(5)};
    const Float4 cosine = min4(__builtin_shufflevector(eye, eye, 2, 3, 3, 3), Float4{1, 0, 0, 0});
    const Float4 light = {across, height, 0, 0};
    const Float4 e = abs4(eye), l = abs4(light);
    const Float4 xx = __builtin_shufflevector(eye, light, 3, 0, 4, 3);
    const Float4 over = __builtin_shufflevector(e, l, 3, 1, 4, 3);
    const Float4 under = __builtin_shufflevector(e, l, 3, 0, 5, 3);
    const Float4 quadrant =
        first_quadrant(over, under, polynomials, cosine, sqrt4(Float4{1, 0, 0, 0} - cosine)) *
        Float4{1, 1, 1 / kQuarter, 0};
    const Int4 left = xx < 0;
    const Int4 back = __builtin_shufflevector(eye, eye, 3, 1, 3, 3) < 0;
    const Float4 half = negate_where(left, quadrant) + keep_where(left, Float4{0, kHalf, 0, 0});
    return negate_where(back, half) + keep_where(back, Float4{0, kWhole, 0, 0});
}

} // namespace rapport
