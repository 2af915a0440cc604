#include "vgsp/micro_element.h"

#include "tests/support/long_run.h"
#include "tests/support/scattering.h"

#include <gtest/gtest.h>

// A cloth lying across: the draft turned by 90° with warp and weft exchanged is the same cloth, so
// all that it does to light is turned by 90° with it.

namespace rapport {
namespace {

const uint64_t kPaths = tests::long_run() ? 1'000'000 : 100'000;

/// Turned from x to y: the ends become picks, and the picks ends, in reverse.
Draft turned(const Draft& draft) {
    Draft result;
    result.ends = draft.picks;
    result.picks = draft.ends;
    result.warp_up.resize(draft.warp_up.size());
    for (int pick = 0; pick < draft.picks; ++pick)
        for (int end = 0; end < draft.ends; ++end)
            result.set_up(draft.picks - 1 - pick, end, !draft.up(end, pick));
    return result;
}

/// A 3/1 twill of unlike yarns: no symmetry of its own hides a mistake.
Cloth denim() {
    YarnSpec warp = tests::loose_yarn(64, 16);
    warp.section = YarnSection::twisted;
    warp.twist_per_m = 600;
    warp.fibre.diameter_um = 14;
    Cloth cloth =
        tests::cloth_of(named_weave("twill 3/1 Z"), warp, tests::loose_yarn(50, 12), 60, 80);
    cloth.crimp_balance = 0.7;
    return cloth;
}

Cloth turned(const Cloth& cloth) {
    Cloth result = tests::cloth_of(turned(cloth.draft), cloth.weft, cloth.warp, cloth.picks_per_cm,
                                   cloth.ends_per_cm);
    result.crimp_balance = 1 - cloth.crimp_balance;
    return result;
}

const std::vector<IncidentDirection> kIncident{{Side::front, 0, 0},
                                               {Side::front, radians(35.0), radians(20.0)},
                                               {Side::front, radians(70.0), radians(130.0)},
                                               {Side::back, radians(50.0), radians(290.0)}};

/// All of `kIncident`, or, of a turned cloth, the same turned; counted where they would be
/// unturned.
std::vector<tests::ExitCounts> exits(const Cloth& cloth, bool turned, bool turned_back,
                                     uint64_t seed) {
    std::vector<IncidentDirection> incident = kIncident;
    for (IncidentDirection& direction : incident)
        direction.phi += turned ? kPi / 2 : 0;
    // Fine segments in the same places: no difference between two realisations of the dither.
    const MicroElement element =
        build_micro_element(cloth, {.max_turn_degrees = 0.5, .dither = false});
    return tests::scattered(kernel::FibreTracer(element.fibres), tests::clear_fibres(1.53, 1),
                            incident, kPaths, seed,
                            turned_back ? tests::turned_back : tests::unmoved);
}

TEST(TurnedDraft, FourTurnsAreNone) {
    const Draft draft = denim().draft;
    EXPECT_EQ(turned(turned(turned(turned(draft)))).warp_up, draft.warp_up);
    EXPECT_NE(turned(draft).warp_up, draft.warp_up);
}

TEST(TurnedDraft, WithItsYarnsExchangedScattersTheSameTurned) {
    const auto cloth = exits(denim(), false, false, 1);
    const auto across = exits(turned(denim()), true, true, 2);
    // What is near, but wrong, is told apart: not turned back, yarns not exchanged.
    const auto not_back = exits(turned(denim()), true, false, 2);
    Cloth unexchanged = turned(denim());
    std::swap(unexchanged.warp.fibre.diameter_um, unexchanged.weft.fibre.diameter_um);
    const auto wrong = exits(unexchanged, true, true, 3);
    for (size_t d = 0; d < kIncident.size(); ++d) {
        const double least = tests::sidak(0.01, static_cast<int>(kIncident.size()));
        EXPECT_GT(tests::same_scattering(cloth[d], across[d]).p_value, least) << d;
        EXPECT_LT(tests::same_scattering(cloth[d], not_back[d]).p_value, 1e-6) << d;
        EXPECT_LT(tests::same_scattering(cloth[d], wrong[d]).p_value, 1e-6) << d;
    }
}

} // namespace
} // namespace rapport
