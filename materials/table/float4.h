#pragma once

#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>

namespace rapport {

// Four floats side by side, in the vectors of GCC and Clang: `experimental::simd` of g++ 12 leaves
// its small functions out of line, where vectors pass through memory. Nothing here rounds
// differently on one machine than on another.

using Float4 = float __attribute__((vector_size(16)));
using Int4 = int32_t __attribute__((vector_size(16)));
using Word8 = uint16_t __attribute__((vector_size(16)));

inline Float4 four(float x) { return Float4{x, x, x, x}; }
inline Float4 min4(Float4 a, Float4 b) {
#ifdef __SSE__
    return __builtin_ia32_minps(a, b); // GCC finds it in the other form only sometimes
#else
    return a < b ? a : b;
#endif
}
inline Float4 max4(Float4 a, Float4 b) {
#ifdef __SSE__
    return __builtin_ia32_maxps(a, b);
#else
    return a > b ? a : b;
#endif
}
inline Float4 clamp4(Float4 x, float low, float high) {
    return max4(min4(x, four(high)), four(low));
}
inline Float4 abs4(Float4 x) { return std::bit_cast<Float4>(std::bit_cast<Int4>(x) & 0x7fffffff); }

/// −x where `negative`, x elsewhere.
inline Float4 negate_where(Int4 negative, Float4 x) {
    return std::bit_cast<Float4>(std::bit_cast<Int4>(x) ^ (negative & INT32_MIN));
}
/// x where `kept`, 0 elsewhere.
inline Float4 keep_where(Int4 kept, Float4 x) {
    return std::bit_cast<Float4>(std::bit_cast<Int4>(x) & kept);
}

/// Of numbers ≥ 0. `std::sqrt` would ask each whether it is.
inline Float4 sqrt4(Float4 x) {
#ifdef __SSE__
    return __builtin_ia32_sqrtps(x);
#else
    return Float4{std::sqrt(x[0]), std::sqrt(x[1]), std::sqrt(x[2]), std::sqrt(x[3])};
#endif
}

using Float2 = float __attribute__((vector_size(8)));
/// x, y, z and 0.
inline Float4 load_xyz(const float* xyz) {
    Float2 xy;
    std::memcpy(&xy, xyz, sizeof xy);
    return __builtin_shufflevector(xy, Float2{xyz[2], 0}, 0, 1, 2, 3);
}
/// Two floats from each of two places.
inline Float4 load_pairs(const float* first, const float* second) {
    Float2 low, high;
    std::memcpy(&low, first, sizeof low);
    std::memcpy(&high, second, sizeof high);
    return __builtin_shufflevector(low, high, 0, 1, 2, 3);
}

/// The first and the last four of eight 16-bit numbers.
inline Float4 low_words(Word8 words) {
    return __builtin_convertvector(
        std::bit_cast<Int4>(__builtin_shufflevector(words, Word8{}, 0, 8, 1, 9, 2, 10, 3, 11)),
        Float4);
}
inline Float4 high_words(Word8 words) {
    return __builtin_convertvector(
        std::bit_cast<Int4>(__builtin_shufflevector(words, Word8{}, 4, 12, 5, 13, 6, 14, 7, 15)),
        Float4);
}

inline Float4 load4(const float* numbers) {
    Float4 four;
    std::memcpy(&four, numbers, sizeof four);
    return four;
}

/// Ascending numbers in a cache line.
struct alignas(64) Line {
    float numbers[16];

    static constexpr size_t lines(size_t numbers) { return (numbers + 15) / 16; }
};
/// How many of those in `lines` lines are ≤ x: down to four lines by halving, which takes the
/// logarithm of their number, and in what is left by comparing all, four at a time: for short lists
/// that is sooner done than a search with its branches.
inline size_t count_up_to(const Line* const first, size_t lines, float x) {
    const Line* line = first;
    while (lines > 4) {
        const size_t half = lines / 2;
        line = line[half - 1].numbers[15] <= x ? line + half : line;
        lines -= half;
    }
    const size_t before = 16 * static_cast<size_t>(line - first);
    const Float4 xxxx = four(x);
    Int4 found{};
    for (const Line* const end = line + lines; line < end; ++line) {
        const float* const f = line->numbers;
        found += ((load4(f) <= xxxx) + (load4(f + 4) <= xxxx)) +
                 ((load4(f + 8) <= xxxx) + (load4(f + 12) <= xxxx));
    }
    found += __builtin_shufflevector(found, found, 2, 3, 0, 1);
    return before + static_cast<uint32_t>(-(found[0] + found[1]));
}

} // namespace rapport
