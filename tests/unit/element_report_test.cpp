#include "renderer/core/math.h"
#include "tests/support/fibre_assemblies.h"
#include "vgsp/element_report.h"

#include <gtest/gtest.h>

namespace rapport {
namespace {

TEST(ElementReport, OverlapOfTwoCylindersIsTheClosedForm) {
    // Axes 1.6 apart, radii 1: the angle with cos = 0.8 on both sides is covered.
    kernel::FibreAssembly pair{{10, 7},
                               {{{{2, 0, 0}}, {0, 7, 0}, 1, 0}, {{{3.6, 0, 0}}, {0, 7, 0}, 1, 0}}};
    EXPECT_NEAR(overlap_fraction(pair, kernel::fibre_segments(pair)), std::acos(0.8) / kPi, 0.003);
    // The same across the cell's edge, and as one chain that passes through two cells.
    pair.chains[0].points[0].x = 0.5;
    pair.chains[1].points[0].x = 8.9;
    EXPECT_NEAR(overlap_fraction(pair, kernel::fibre_segments(pair)), std::acos(0.8) / kPi, 0.003);
    const kernel::FibreAssembly slanted{{8, 1.8}, {{{{0, 0, 0}}, {8, 1.8, 0}, 1, 0}}};
    const double apart = 1.8 * 8 / std::hypot(8, 1.8);
    EXPECT_NEAR(overlap_fraction(slanted, kernel::fibre_segments(slanted)),
                2 * std::acos(apart / 2) / kPi, 0.003);
    // A fibre is never inside itself.
    const kernel::FibreAssembly wide{{8, 8}, {{{{0, 0, 0}}, {8, 8, 0}, 1, 0}}};
    EXPECT_EQ(overlap_fraction(wide, kernel::fibre_segments(wide)), 0);
}

TEST(ElementReport, SeparateFibresDoNotOverlap) {
    const kernel::FibreAssembly stack = tests::reference_stack();
    EXPECT_EQ(overlap_fraction(stack, kernel::fibre_segments(stack)), 0);
    // The same stack with fibres so thick that neighbours meet: 2·acos(1/1.1)/π of the surface by
    // those of the same layer, and some more by those of the layers above and below.
    const kernel::FibreAssembly thick = tests::fibre_stack(2, 10, 5.5, 4);
    EXPECT_GT(overlap_fraction(thick, kernel::fibre_segments(thick)), 2 * std::acos(1 / 1.1) / kPi);
}

TEST(ElementReport, NothingHasNoOverlap) { EXPECT_EQ(overlap_fraction({{1, 1}, {}}, {}), 0); }

} // namespace
} // namespace rapport
