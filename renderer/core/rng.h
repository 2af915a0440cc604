#pragma once

#include <Random123/philox.h>
#include <cstdint>

namespace rapport {

/// What a stream of random numbers is for; streams of different purpose never share numbers.
enum class Purpose : uint32_t {
    pixel,
    incident_path,
    fibre_dither,
    fibre_jitter,
    colour_solve,
    walk,
    test,
    realisation,
};

/// Counter-based random numbers (Philox4x32-10; Salmon et al. 2011, "Parallel Random Numbers: As
/// Easy as 1, 2, 3"): the stream is a pure function of (seed, purpose, index, sample), so results
/// do not depend on which thread draws it, or when.
class CounterRng {
  public:
    /// `index` is the pixel or incident cell, `sample` the path within it.
    CounterRng(uint64_t seed, Purpose purpose, uint64_t index, uint64_t sample)
        : counter_{{0, static_cast<uint32_t>(sample), static_cast<uint32_t>(index),
                    static_cast<uint32_t>(index >> 32) ^
                        (static_cast<uint32_t>(sample >> 32) << 16)}},
          key_{{static_cast<uint32_t>(seed), static_cast<uint32_t>(seed >> 32) ^
                                                 (static_cast<uint32_t>(purpose) * 0x9E3779B9u)}} {}

    uint32_t bits() {
        if (used_ == 4) {
            block_ = r123::Philox4x32{}(counter_, key_);
            ++counter_[0];
            used_ = 0;
        }
        return block_[used_++];
    }

    /// Uniform in [0, 1), 24 bits.
    float uniform_float() { return static_cast<float>(bits() >> 8) * 0x1p-24f; }
    /// Uniform in (0, 1), 32 bits, never an end point.
    double uniform() { return (bits() + 0.5) * 0x1p-32; }

  private:
    r123::Philox4x32::ctr_type counter_;
    r123::Philox4x32::key_type key_;
    r123::Philox4x32::ctr_type block_{};
    int used_ = 4;
};

} // namespace rapport
