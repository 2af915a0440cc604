#pragma once

#include <cstdint>

// The first two dimensions of Sobol's sequence, a (0, 2)-sequence in base 2: of every aligned
// block of 2^k points, exactly one lies in each of the 2^k boxes of size 2^-i × 2^-(k-i), for
// every i. Fractions are of 2^32 with their bits in reverse, the first one worth a half: that is
// the form in which all here is computed.

namespace rapport::sobol {

constexpr uint32_t reverse_bits(uint32_t x) {
    x = x >> 16 | x << 16;
    x = (x & 0xFF00FF00u) >> 8 | (x & 0x00FF00FFu) << 8;
    x = (x & 0xF0F0F0F0u) >> 4 | (x & 0x0F0F0F0Fu) << 4;
    x = (x & 0xCCCCCCCCu) >> 2 | (x & 0x33333333u) << 2;
    return (x & 0xAAAAAAAAu) >> 1 | (x & 0x55555555u) << 1;
}

/// Van der Corput's radical inverse.
constexpr uint32_t first_dimension(uint32_t index) { return index; }

/// Generator matrix: Pascal's triangle modulo 2, whose entry (row r, column c) is 1 where the bits
/// of r are among those of c (Lucas), the Kronecker power of [1 1; 0 1]: one step per bit of a row.
constexpr uint32_t second_dimension(uint32_t index) {
    index ^= index >> 1 & 0x55555555u;
    index ^= index >> 2 & 0x33333333u;
    index ^= index >> 4 & 0x0F0F0F0Fu;
    index ^= index >> 8 & 0x00FF00FFu;
    return index ^ index >> 16;
}

/// Owen's nested uniform scrambling (Burley 2020): each bit is flipped depending on those worth
/// more, which keeps the points' stratification. The hash has the form of Laine & Karras 2011, with
/// the constants that Vegdahl 2021 ("Building a Better LK Hash") found to scramble best.
constexpr uint32_t owen_scramble(uint32_t fraction, uint32_t seed) {
    fraction ^= fraction * 0x3D20ADEAu;
    fraction += seed;
    fraction *= seed >> 16 | 1;
    fraction ^= fraction * 0x05526C56u;
    return fraction ^ fraction * 0x53A22864u;
}

} // namespace rapport::sobol
