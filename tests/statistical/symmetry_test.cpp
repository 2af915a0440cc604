#include "vgsp/micro_element.h"

#include "tests/support/long_run.h"
#include "tests/support/scattering.h"

#include <gtest/gtest.h>

// A weave's own symmetries are those of what it does to light.

namespace rapport {
namespace {

const uint64_t kPaths = tests::long_run() ? 1'000'000 : 100'000;

constexpr double kTheta = radians(40.0), kPhi = radians(20.0);
/// A direction, turned by 90° and 180°, mirrored, and from the other side.
const std::vector<IncidentDirection> kIncident{{Side::front, kTheta, kPhi},
                                               {Side::front, kTheta, kPhi + kPi / 2},
                                               {Side::front, kTheta, kPhi + kPi},
                                               {Side::front, kTheta, kPi - kPhi},
                                               {Side::back, kTheta, kPhi}};
constexpr size_t kFirst = 0, kTurned = 1, kHalfTurned = 2, kMirrored = 3, kBack = 4;

/// One cloth under light from `kIncident`.
class Scattering {
  public:
    explicit Scattering(const Cloth& cloth)
        : tracer_(build_micro_element(cloth, {.max_turn_degrees = 0.5, .dither = false}).fibres),
          first_(exits(kFirst, tests::unmoved)) {}

    /// Whether another of the directions, moved, scatters as the first.
    double p(size_t direction, tests::Motion motion) const {
        return tests::same_scattering(first_, exits(direction, motion)).p_value;
    }

  private:
    tests::ExitCounts exits(size_t direction, tests::Motion motion) const {
        return tests::scattered(tracer_, tests::clear_fibres(1.53, 1), {kIncident[direction]},
                                kPaths, direction, motion)[0];
    }

    kernel::FibreTracer tracer_;
    tests::ExitCounts first_;
};

const double kLeast = tests::sidak(0.01, 4);
constexpr double kTold = 1e-6;

TEST(Symmetry, OfABalancedPlainWeave) {
    const YarnSpec yarn = tests::loose_yarn();
    const Scattering plain(tests::cloth_of(named_weave("plain"), yarn, yarn));
    EXPECT_GT(plain.p(kTurned, tests::turned_back), kLeast) << "warp and weft exchanged";
    EXPECT_GT(plain.p(kHalfTurned, tests::half_turned), kLeast);
    EXPECT_GT(plain.p(kMirrored, tests::mirrored), kLeast);
    EXPECT_GT(plain.p(kBack, tests::turned_over), kLeast);
    EXPECT_LT(plain.p(kTurned, tests::unmoved), kTold);
    EXPECT_LT(plain.p(kMirrored, tests::unmoved), kTold);
}

/// Turning the cloth over about the bisector of warp and weft is all that is left.
TEST(Symmetry, OfASatin) {
    const YarnSpec yarn = tests::loose_yarn();
    const Scattering satin(tests::cloth_of(named_weave("satin 5/2"), yarn, yarn));
    EXPECT_GT(satin.p(kHalfTurned, tests::half_turned), kLeast);
    EXPECT_LT(satin.p(kTurned, tests::turned_back), kTold) << "warp floats are not weft floats";
    EXPECT_LT(satin.p(kBack, tests::turned_over), kTold) << "nor is its back its face";
}

TEST(Symmetry, IsLostWithUnlikeYarns) {
    const Scattering plain(
        tests::cloth_of(named_weave("plain"), tests::loose_yarn(), tests::loose_yarn(50, 12)));
    EXPECT_GT(plain.p(kMirrored, tests::mirrored), kLeast);
    EXPECT_LT(plain.p(kTurned, tests::turned_back), kTold);
}

} // namespace
} // namespace rapport
