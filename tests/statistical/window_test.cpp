#include "vgsp/micro_element.h"

#include "tests/support/fibre_assemblies.h"
#include "tests/support/long_run.h"
#include "tests/support/scattering.h"

#include <gtest/gtest.h>

// The micro-element is a window on an endless cloth: which repeat it shows, and how many of them,
// is no matter.

namespace rapport {
namespace {

using kernel::FibreAssembly;
using kernel::FibreChain;
using kernel::FibreTracer;

const uint64_t kPaths = tests::long_run() ? 1'000'000 : 100'000;
const std::vector<IncidentDirection> kIncident{{Side::front, 0, 0},
                                               {Side::front, radians(35.0), radians(20.0)},
                                               {Side::front, radians(75.0), radians(130.0)},
                                               {Side::back, radians(50.0), radians(290.0)}};

using Counts = std::vector<tests::ExitCounts>; ///< of each of the directions

void expect_same(const Counts& a, const Counts& b) {
    for (size_t d = 0; d < kIncident.size(); ++d)
        EXPECT_GT(tests::same_scattering(a[d], b[d]).p_value,
                  tests::sidak(0.01, static_cast<int>(kIncident.size())))
            << "direction " << d;
}

void expect_other(const Counts& a, const Counts& b) {
    for (size_t d = 0; d < kIncident.size(); ++d)
        EXPECT_LT(tests::same_scattering(a[d], b[d]).p_value, 1e-6) << "direction " << d;
}

Counts exits(const FibreAssembly& assembly, uint64_t seed) {
    return tests::scattered(FibreTracer(assembly), tests::clear_fibres(1.53, 1), kIncident, kPaths,
                            seed);
}

Draft moved(const Draft& draft, int ends, int picks) {
    Draft result = draft;
    for (int pick = 0; pick < draft.picks; ++pick)
        for (int end = 0; end < draft.ends; ++end)
            result.set_up((end + ends) % draft.ends, (pick + picks) % draft.picks,
                          draft.up(end, pick));
    return result;
}

FibreAssembly woven(const Draft& draft) {
    const Cloth cloth =
        tests::cloth_of(draft, tests::loose_yarn(), tests::loose_yarn(50, 12), 70, 90);
    return build_micro_element(cloth, {.max_turn_degrees = 0.5, .dither = false}).fibres;
}

TEST(Window, AnyPlaceOfTheDraftIsTheSameCloth) {
    const Draft draft = named_weave("twill 3/1 S");
    const Counts cloth = exits(woven(draft), 1);
    ASSERT_NE(moved(draft, 1, 2).warp_up, draft.warp_up);
    expect_same(cloth, exits(woven(moved(draft, 1, 2)), 2));
    expect_other(cloth, exits(woven(named_weave("twill 2/2 S")), 3));
}

/// 2 × 2 cells as one. A fibre that closes after an odd number of cells along x or y then closes
/// after twice as many.
FibreAssembly doubled(const FibreAssembly& assembly) {
    FibreAssembly result{2.0 * assembly.cell, {}};
    for (const FibreChain& chain : assembly.chains) {
        const int x = static_cast<int>(std::round(chain.period.x / assembly.cell.x)) % 2;
        const int y = static_cast<int>(std::round(chain.period.y / assembly.cell.y)) % 2;
        const bool closes = x == 0 && y == 0;
        FibreChain longer = chain;
        if (!closes) {
            for (const glm::dvec3& point : chain.points)
                longer.points.push_back(point + chain.period);
            longer.period *= 2.0;
        }
        // Copies one period apart are one fibre.
        for (int row = 0; row < (y != 0 ? 1 : 2); ++row)
            for (int column = 0; column < (x != 0 && y == 0 ? 1 : 2); ++column) {
                FibreChain copy = longer;
                for (glm::dvec3& point : copy.points)
                    point += glm::dvec3(column * assembly.cell.x, row * assembly.cell.y, 0);
                result.chains.push_back(std::move(copy));
            }
    }
    return result;
}

double length(const FibreAssembly& assembly) {
    double sum = 0;
    for (const kernel::FibreSegment& segment : kernel::fibre_segments(assembly))
        sum += segment.length;
    return sum;
}

TEST(Window, FourCellsAsOneAreTheSameCloth) {
    const FibreAssembly one = tests::winding_fibres(), four = doubled(one);
    EXPECT_NEAR(length(four), 4 * length(one), 1e-9 * length(four));
    const Counts cloth = exits(one, 1);
    expect_same(cloth, exits(four, 2));
    FibreAssembly thicker = doubled(one);
    for (FibreChain& chain : thicker.chains)
        chain.radius *= 1.1;
    expect_other(cloth, exits(thicker, 3));
}

} // namespace
} // namespace rapport
