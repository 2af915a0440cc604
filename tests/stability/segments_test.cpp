#include "vgsp/incident_path.h"

#include "tests/support/long_run.h"
#include "tests/support/mirror_images.h"

#include <gtest/gtest.h>

// Fibres of too few straight segments put the light into as many narrow peaks: the paper's
// calculated charts, against its measured ones. Finer segments, laid differently in each fibre,
// take them away.

namespace rapport {
namespace {

const int kPaths = tests::long_run() ? 6'000'000 : 1'500'000;

/// What noise alone makes of difference(a, b).
double noise(const tests::MirrorImages& a, const tests::MirrorImages& b) {
    tests::MirrorImages apart = b;
    for (int step = 0; step < tests::MirrorImages::kSteps; ++step)
        apart.density[step] += std::hypot(a.error[step], b.error[step]);
    return tests::difference(apart, b);
}

TEST(Segments, TooFewMakePeaksThatFineOnesCure) {
    const tests::MirrorImages limit = tests::mirror_images(0.25, true, kPaths, 1);
    const tests::MirrorImages coarse = tests::mirror_images(16, false, kPaths, 2);
    const tests::MirrorImages finer = tests::mirror_images(8, false, kPaths, 3);
    const tests::MirrorImages used = tests::mirror_images(1, true, kPaths, 4);
    EXPECT_LT(coarse.segments, used.segments / 8);
    // As high as the paper's against its measurements.
    EXPECT_GT(tests::peak(coarse), 3 * tests::peak(limit));
    EXPECT_GT(tests::peak(finer), 1.4 * tests::peak(limit));
    EXPECT_NEAR(tests::peak(used), tests::peak(limit), 0.2 * tests::peak(limit));
    // The error falls to what is noise.
    EXPECT_GT(tests::difference(coarse, limit), 1);
    EXPECT_GT(tests::difference(finer, limit), 0.5);
    EXPECT_LT(tests::difference(used, limit), 1.25 * noise(used, limit));
}

} // namespace
} // namespace rapport
