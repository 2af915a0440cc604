#include "tests/support/peak_memory.h"
#include "vgsp/measure_cloth.h"

#include <gtest/gtest.h>

namespace rapport {
namespace {

// The largest cloth that is shipped. In a program of its own: a process tells only the most memory
// that it ever held.
TEST(Realisations, OfDenimAreAsManyAsTheMemoryHolds) {
    constexpr double kMemory = 1e9;
    const Cloth denim = read_cloth(RAPPORT_SOURCE_DIR "/scenes/cloths/denim.toml");
    const double before = tests::peak_memory();
    const Realisations realisations = build_realisations(denim, {}, 4, kMemory);
    const double count = static_cast<double>(realisations.tracers.size());
    EXPECT_GE(count, 2);
    EXPECT_GT((count + 1) * realisations.first.memory, kMemory);
    if (before > 0) {
        const double taken = tests::peak_memory() - before;
        std::printf("%g realisations: %.0f MB (at most %.0f MB each)\n", count, taken * 1e-6,
                    realisations.first.memory * 1e-6);
        EXPECT_LT(taken, kMemory);
        EXPECT_LT(taken, 1.05 * count * realisations.first.memory);
        EXPECT_GT(taken, 0.5 * count * realisations.first.memory);
    }
}

} // namespace
} // namespace rapport
