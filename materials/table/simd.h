#pragma once

#include <algorithm>
#include <cmath>
#include <experimental/simd>

/// For the small functions of a look-up over Float4: g++ leaves them out of line, where their
/// vectors pass through memory, which takes a third longer.
#define RAPPORT_INLINE [[gnu::always_inline]] inline

namespace rapport {

/// Four floats side by side; operators work lane by lane.
using Float4 = std::experimental::simd<float, std::experimental::simd_abi::deduce_t<float, 4>>;

// What numerical templates need besides operators, for one float and for four.

inline float select(bool condition, float yes, float no) { return condition ? yes : no; }
RAPPORT_INLINE Float4 select(const Float4::mask_type& condition, Float4 yes, const Float4& no) {
    std::experimental::where(!condition, yes) = no;
    return yes;
}

} // namespace rapport
