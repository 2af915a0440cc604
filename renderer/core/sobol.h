#pragma once

#include <cstdint>

// The first two dimensions of Sobol's sequence, a (0, 2)-sequence in base 2: of every aligned
// block of 2^k points, exactly one lies in each of the 2^k boxes of size 2^-i × 2^-(k-i), for
// every i. Values are fractions of 2^32.

namespace rapport::sobol {

constexpr uint32_t reverse_bits(uint32_t x) {
    x = x >> 16 | x << 16;
    x = (x & 0xFF00FF00u) >> 8 | (x & 0x00FF00FFu) << 8;
    x = (x & 0xF0F0F0F0u) >> 4 | (x & 0x0F0F0F0Fu) << 4;
    x = (x & 0xCCCCCCCCu) >> 2 | (x & 0x33333333u) << 2;
    return (x & 0xAAAAAAAAu) >> 1 | (x & 0x55555555u) << 1;
}

/// Van der Corput's radical inverse.
constexpr uint32_t first_dimension(uint32_t index) { return reverse_bits(index); }

/// Generator matrix: Pascal's triangle modulo 2, whose entry (row r, column c) is 1 where the bits
/// of r are among those of c (Lucas), the Kronecker power of [1 1; 0 1]: one step per bit of a row.
constexpr uint32_t second_dimension(uint32_t index) {
    index ^= index >> 1 & 0x55555555u;
    index ^= index >> 2 & 0x33333333u;
    index ^= index >> 4 & 0x0F0F0F0Fu;
    index ^= index >> 8 & 0x00FF00FFu;
    index ^= index >> 16;
    return reverse_bits(index);
}

/// A hash in which every bit of the result depends only on the same and lower bits of `x`: the
/// form of Laine & Karras 2011, with the constants that Vegdahl 2021 ("Building a Better LK
/// Hash") found to scramble best.
constexpr uint32_t laine_karras_permutation(uint32_t x, uint32_t seed) {
    x ^= x * 0x3D20ADEAu;
    x += seed;
    x *= seed >> 16 | 1;
    x ^= x * 0x05526C56u;
    x ^= x * 0x53A22864u;
    return x;
}

/// Owen's nested uniform scrambling (Burley 2020): each bit is flipped depending on those above
/// it, which keeps the points' stratification. Applied to an index it shuffles the sequence while
/// every aligned block of 2^k indices stays one.
constexpr uint32_t owen_scramble(uint32_t x, uint32_t seed) {
    return reverse_bits(laine_karras_permutation(reverse_bits(x), seed));
}

} // namespace rapport::sobol
