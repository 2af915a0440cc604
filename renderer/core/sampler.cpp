#include "renderer/core/sampler.h"

#include "renderer/core/sobol.h"

namespace rapport {
namespace {

constexpr uint64_t kGolden = 0x9E3779B97F4A7C15u; ///< 2^64 over the golden ratio

/// A bijection of 64 bits that leaves no visible pattern (Steele et al. 2014, SplitMix64).
uint64_t mix(uint64_t x) {
    x = (x ^ (x >> 30)) * 0xBF58476D1CE4E5B9u;
    x = (x ^ (x >> 27)) * 0x94D049BB133111EBu;
    return x ^ (x >> 31);
}

float unit_float(uint32_t fraction) {
    return static_cast<float>(sobol::reverse_bits(fraction) >> 8) * 0x1p-24f;
}

/// Another order of the samples, in which every aligned block of 2^k of them stays one.
uint32_t shuffled(uint32_t reversed_sample, uint32_t seed) {
    return sobol::reverse_bits(sobol::owen_scramble(reversed_sample, seed));
}

/// The seeds of one padded dimension or pair: one to shuffle the index, one to scramble each axis.
struct PadSeeds {
    uint32_t shuffle, x, y;

    PadSeeds(uint64_t scramble_seed, uint32_t dimension) {
        const uint64_t first = mix(scramble_seed + dimension * kGolden);
        const uint64_t second = mix(first + kGolden);
        shuffle = static_cast<uint32_t>(first);
        x = static_cast<uint32_t>(first >> 32);
        y = static_cast<uint32_t>(second);
    }
};

} // namespace

Sampler::Sampler(Kind kind, uint64_t seed, uint64_t pixel, uint32_t sample)
    : kind_(kind), rng_(seed, Purpose::pixel, pixel, sample),
      scramble_seed_(mix(mix(seed + kGolden) + 2 * pixel + sample % 2)),
      reversed_sample_(sobol::reverse_bits(sample / 2)) {}

float Sampler::next_1d() {
    if (kind_ == Kind::independent)
        return rng_.uniform_float();
    const PadSeeds seeds(scramble_seed_, dimension_++);
    const uint32_t index = shuffled(reversed_sample_, seeds.shuffle);
    return unit_float(sobol::owen_scramble(sobol::first_dimension(index), seeds.x));
}

glm::vec2 Sampler::next_2d() {
    if (kind_ == Kind::independent) {
        const float x = rng_.uniform_float();
        return {x, rng_.uniform_float()};
    }
    const PadSeeds seeds(scramble_seed_, dimension_++);
    const uint32_t index = shuffled(reversed_sample_, seeds.shuffle);
    return {unit_float(sobol::owen_scramble(sobol::first_dimension(index), seeds.x)),
            unit_float(sobol::owen_scramble(sobol::second_dimension(index), seeds.y))};
}

CounterRng Sampler::stream() {
    const uint64_t high = rng_.bits();
    return {high << 32 | rng_.bits(), Purpose::walk, 0, 0};
}

} // namespace rapport
