#include "vgsp/micro_element.h"

#include "tests/support/long_run.h"
#include "tests/support/scattering.h"

#include <gtest/gtest.h>

// A weave's own symmetries are those of what it does to light.

namespace rapport {
namespace {

const uint64_t kPaths = tests::long_run() ? 1'000'000 : 100'000;

BsdfTable measured(const Cloth& cloth, const std::vector<IncidentDirection>& incident) {
    const MicroElement element =
        build_micro_element(cloth, {.max_turn_degrees = 0.5, .dither = false});
    return tests::measured(kernel::FibreTracer(element.fibres), tests::clear_fibres(), incident,
                           kPaths, 4);
}

size_t half_turned_bin(const DirectionMesh& mesh, size_t bin) {
    return tests::turned_bin(mesh, tests::turned_bin(mesh, bin));
}

constexpr double kTheta = radians(40.0), kPhi = radians(20.0);
/// A direction, turned by 90° and 180°, mirrored, and from the other side.
const std::vector<IncidentDirection> kIncident{{Side::front, kTheta, kPhi},
                                               {Side::front, kTheta, kPhi + kPi / 2},
                                               {Side::front, kTheta, kPhi + kPi},
                                               {Side::front, kTheta, kPi - kPhi},
                                               {Side::back, kTheta, kPhi}};
constexpr size_t kTurned = 1, kHalfTurned = 2, kMirrored = 3, kBack = 4;

const double kLeast = tests::sidak(0.01, 4);
constexpr double kTold = 1e-6;

TEST(Symmetry, OfABalancedPlainWeave) {
    const YarnSpec yarn = tests::loose_yarn();
    const BsdfTable plain = measured(tests::cloth_of(named_weave("plain"), yarn, yarn), kIncident);
    const auto p = [&](size_t direction, const tests::BinMap& map) {
        return tests::same_scattering(plain, 0, plain, direction, map).p_value;
    };
    EXPECT_GT(p(kTurned, tests::turned_bin), kLeast) << "warp and weft exchanged";
    EXPECT_GT(p(kHalfTurned, half_turned_bin), kLeast);
    EXPECT_GT(p(kMirrored, tests::mirrored_bin), kLeast);
    EXPECT_GT(p(kBack, tests::same_bin), kLeast);
    EXPECT_LT(p(kTurned, tests::same_bin), kTold);
    EXPECT_LT(p(kMirrored, tests::same_bin), kTold);
}

/// Turning the cloth over about the bisector of warp and weft is all that is left.
TEST(Symmetry, OfASatin) {
    const YarnSpec yarn = tests::loose_yarn();
    const BsdfTable satin =
        measured(tests::cloth_of(named_weave("satin 5/2"), yarn, yarn), kIncident);
    const auto p = [&](size_t direction, const tests::BinMap& map) {
        return tests::same_scattering(satin, 0, satin, direction, map).p_value;
    };
    EXPECT_GT(p(kHalfTurned, half_turned_bin), kLeast);
    EXPECT_LT(p(kTurned, tests::turned_bin), kTold) << "warp floats are not weft floats";
    EXPECT_LT(p(kBack, tests::same_bin), kTold) << "nor is its back its face";
}

TEST(Symmetry, IsLostWithUnlikeYarns) {
    const BsdfTable plain = measured(
        tests::cloth_of(named_weave("plain"), tests::loose_yarn(), tests::loose_yarn(50, 12)),
        kIncident);
    EXPECT_GT(tests::same_scattering(plain, 0, plain, kMirrored, tests::mirrored_bin).p_value,
              kLeast);
    EXPECT_LT(tests::same_scattering(plain, 0, plain, kTurned, tests::turned_bin).p_value, kTold);
}

} // namespace
} // namespace rapport
