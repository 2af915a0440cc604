#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <vector>

namespace rapport {

// Four floats side by side, in the vectors of GCC and Clang: `experimental::simd` of g++ 12 leaves
// its small functions out of line, where vectors pass through memory.

using Float4 = float __attribute__((vector_size(16)));
using Int4 = int32_t __attribute__((vector_size(16)));

/// Of four 16-bit numbers in memory.
inline Float4 load_uint16(const void* four) {
    uint16_t __attribute__((vector_size(8))) narrow;
    std::memcpy(&narrow, four, sizeof narrow);
    return __builtin_convertvector(__builtin_convertvector(narrow, Int4), Float4);
}

/// How many of ascending numbers are ≤ x, by comparing all, four at a time: for short lists that
/// is sooner done than a search with its branches.
inline size_t count_up_to(std::span<const Float4> numbers, float x) {
    Int4 found{};
    for (const Float4& four : numbers)
        found -= four <= x;
    return static_cast<size_t>(found[0] + found[1] + found[2] + found[3]);
}

/// Blocks of four with all of `numbers`, filled up with infinity.
inline std::vector<Float4> in_fours(std::span<const float> numbers) {
    std::vector<Float4> fours((numbers.size() + 3) / 4, Float4{} + HUGE_VALF);
    for (size_t i = 0; i < numbers.size(); ++i)
        fours[i / 4][i % 4] = numbers[i];
    return fours;
}

} // namespace rapport
