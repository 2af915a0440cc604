#include "renderer/core/math.h"
#include "renderer/kernel/fibres.h"
#include "tests/support/fibre_assemblies.h"

#include <gtest/gtest.h>

namespace rapport::kernel {
namespace {

using glm::dvec3;

/// A wave along x: `count` points per cell of 10, amplitude 1, and its radius.
FibreAssembly wave(int count, double radius = 0.5, int cells = 1) {
    FibreChain chain{{}, {10.0 * cells, 0, 0}, radius, 7};
    for (int k = 0; k < count * cells; ++k) {
        const double x = 10.0 * k / count;
        chain.points.push_back({x + 3, 5, std::sin(2 * kPi * x / (10.0 * cells))});
    }
    return {{10, 10}, {chain}};
}

TEST(Fibres, ChainClosesOverItsPeriod) {
    for (int cells : {1, 3}) {
        const std::vector<FibreSegment> s = fibre_segments(wave(40, 0.5, cells));
        ASSERT_EQ(s.size(), size_t(40 * cells));
        for (size_t k = 0; k < s.size(); ++k) {
            const FibreSegment& next = s[s[k].next];
            EXPECT_EQ(s[s[k].next].previous, k);
            const dvec3 jump = s[k].next == 0 ? dvec3(10 * cells, 0, 0) : dvec3(0);
            const dvec3 end = s[k].start + s[k].direction * s[k].length;
            EXPECT_LT(length(end - (next.start + jump)), 1e-13);
            EXPECT_EQ(s[k].kind, 7u);
        }
    }
}

TEST(Fibres, NeighboursShareThePlaneThatBisectsThem) {
    const std::vector<FibreSegment> s = fibre_segments(wave(40));
    for (const FibreSegment& segment : s) {
        const FibreSegment& next = s[segment.next];
        EXPECT_EQ(segment.end_normal, next.start_normal);
        EXPECT_NEAR(length(segment.end_normal), 1, 1e-14);
        EXPECT_NEAR(dot(segment.end_normal, segment.direction),
                    dot(segment.end_normal, next.direction), 1e-14);
        EXPECT_GT(dot(segment.end_normal, segment.direction), 0.99);
        EXPECT_NEAR(segment.end_offset, dot(segment.direction * segment.length, segment.end_normal),
                    1e-14);
    }
}

TEST(Fibres, SinglePointIsAStraightFibre) {
    const std::vector<FibreSegment> s = fibre_segments(tests::single_fibre(1, 20));
    ASSERT_EQ(s.size(), 1u);
    EXPECT_EQ(s[0].next, 0u);
    EXPECT_EQ(s[0].previous, 0u);
    EXPECT_EQ(s[0].start_normal, dvec3(0, 1, 0));
    EXPECT_DOUBLE_EQ(s[0].end_offset, s[0].length);
}

TEST(Fibres, ReferenceStackIsLaidOutAsDescribed) {
    const FibreAssembly stack = tests::reference_stack(2);
    const std::vector<FibreSegment> s = fibre_segments(stack);
    ASSERT_EQ(s.size(), 32u);
    const double pitch = stack.cell.x / 2;
    EXPECT_NEAR(stack.chains[0].radius / pitch, 0.02875 / 0.0625, 1e-12);
    double mean_height = 0;
    for (size_t k = 0; k < s.size(); ++k) {
        mean_height += s[k].start.z / 32;
        EXPECT_EQ(s[k].direction, k / 2 % 2 ? dvec3(1, 0, 0) : dvec3(0, 1, 0));
        if (k >= 2) {
            EXPECT_NEAR(s[k].start.z - s[k - 2].start.z, pitch, 1e-12);
        }
    }
    EXPECT_NEAR(mean_height, 0, 1e-12);
}

TEST(Fibres, RefusesWhatIsNoFibre) {
    const auto refuses = [](const FibreAssembly& assembly) {
        EXPECT_THROW(fibre_segments(assembly), std::invalid_argument);
    };
    const FibreAssembly good = wave(40);
    ASSERT_NO_THROW(fibre_segments(good));

    FibreAssembly bad = good;
    bad.chains[0].points[4] = bad.chains[0].points[3];
    refuses(bad);
    bad = good;
    bad.chains[0].points.push_back(bad.chains[0].points[0] + bad.chains[0].period);
    refuses(bad);
    for (double radius : {0.0, -1.0, std::nan("")}) {
        bad = good;
        bad.chains[0].radius = radius;
        refuses(bad);
    }
    for (dvec3 period : {dvec3(10.001, 0, 0), dvec3(10, 5, 0), dvec3(10, 0, 1e-3)}) {
        bad = good;
        bad.chains[0].period = period;
        refuses(bad);
    }
    bad = good;
    bad.chains[0].points[2].y = std::nan("");
    refuses(bad);
    bad = good;
    bad.chains[0].points.clear();
    refuses(bad);
    bad = good;
    bad.cell.y = 0;
    refuses(bad);
}

TEST(Fibres, RefusesBendsTighterThanTheRadius) {
    // The wave's smallest radius of curvature is 1/(2π/10)² = 2.53.
    EXPECT_NO_THROW(fibre_segments(wave(100, 2.4)));
    EXPECT_THROW(fibre_segments(wave(100, 2.7)), std::invalid_argument);

    FibreAssembly folded{{10, 10}, {{{{0, 0, 0}, {12, 0, 0}}, {10, 0, 0}, 0.1, 0}}};
    EXPECT_THROW(fibre_segments(folded), std::invalid_argument);
}

} // namespace
} // namespace rapport::kernel
