#include "vgsp/crossing_lift.h"

#include "renderer/core/rng.h"
#include "vgsp/draft.h"
#include "vgsp/weave.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <gtest/gtest.h>

namespace rapport {
namespace {

constexpr double kApart = 100;

std::vector<double> separations(const Draft& draft) {
    std::vector<double> apart;
    for (int end = 0; end < draft.ends; ++end)
        for (int pick = 0; pick < draft.picks; ++pick)
            apart.push_back(draft.up(end, pick) ? kApart : -kApart);
    return apart;
}

/// Heights of ends and of picks.
struct Heights {
    std::vector<double> warp, weft;
};

Heights heights_of(const std::vector<double>& apart, const std::vector<double>& lift,
                   double balance) {
    Heights heights;
    for (size_t k = 0; k < apart.size(); ++k) {
        heights.warp.push_back(balance * apart[k] + lift[k]);
        heights.weft.push_back((balance - 1) * apart[k] + lift[k]);
    }
    return heights;
}

std::vector<double> lift_of(const Draft& draft, double balance) {
    return crossing_lift(separations(draft), draft.ends, draft.picks, balance);
}

/// The largest force that is left at a crossing of unequal stiffnesses, flatness included.
double imbalance(const std::vector<double>& lift, const std::vector<double>& apart, int ends,
                 int picks, double balance) {
    const Heights heights = heights_of(apart, lift, balance);
    double largest = 0;
    for (int end = 0; end < ends; ++end)
        for (int pick = 0; pick < picks; ++pick) {
            const size_t here = size_t(end * picks + pick);
            double force = 1e-3 * lift[here];
            constexpr std::array<double, 5> kFourth{1, -4, 6, -4, 1};
            for (int k = -2; k <= 2; ++k) {
                const int e = (end + k + 2 * ends) % ends, p = (pick + k + 2 * picks) % picks;
                force += kFourth[k + 2] * ((1 - balance) * heights.warp[size_t(end * picks + p)] +
                                           balance * heights.weft[size_t(e * picks + pick)]);
            }
            largest = std::max(largest, std::abs(force));
        }
    return largest;
}

TEST(CrossingLift, IsNoneInPlainWeaveAndTwills) {
    for (const char* weave : {"plain", "twill 2/2 Z", "twill 3/1 S", "twill 2/1 Z", "basket 2"})
        for (double balance : {0.0, 0.3, 0.5, 1.0}) {
            const Draft draft = named_weave(weave);
            for (const double lift : lift_of(draft, balance))
                EXPECT_NEAR(lift, 0, 1e-6) << weave;
        }
}

// By hand, for a satin of five in steps of two in equally stiff threads: a thread's heights over a
// repeat are ∓1/2, ±1/6, ±5/6, ±5/6 and ±1/6 of the separation.
TEST(CrossingLift, InSatinTheMiddleOfFloatsIsLifted) {
    const Draft satin = named_weave("satin 5/2");
    const Heights heights = heights_of(separations(satin), lift_of(satin, 0.5), 0.5);
    const std::array<double, 5> of_end{-1.0 / 2, 1.0 / 6, 5.0 / 6, 5.0 / 6, 1.0 / 6};
    for (int end = 0; end < 5; ++end) {
        int under = 0;
        while (satin.up(end, under))
            ++under;
        for (int k = 0; k < 5; ++k)
            EXPECT_NEAR(heights.warp[size_t(end * 5 + (under + k) % 5)], of_end[k] * kApart, 0.1);
    }
}

TEST(CrossingLift, IsInBalanceForAnyDraft) {
    CounterRng rng(1, Purpose::test, 0, 0);
    for (const auto& [ends, picks] : {std::pair(12, 17), {2, 31}, {60, 50}})
        for (double balance : {1e-3, 0.5, 0.9}) {
            std::vector<double> apart;
            for (int k = 0; k < ends * picks; ++k)
                apart.push_back((rng.uniform() < 0.5 ? -1 : 1) * (50 + 60 * rng.uniform()));
            const std::vector<double> lift = crossing_lift(apart, ends, picks, balance);
            EXPECT_LT(imbalance(lift, apart, ends, picks, balance), 1e-2);
            const std::vector<double> none(apart.size()); // Peirce's heights, which are not at rest
            EXPECT_GT(imbalance(none, apart, ends, picks, balance), 1);
        }
}

TEST(CrossingLift, GoesOnFromAnyStart) {
    const Draft satin = named_weave("satin 8/3");
    const std::vector<double> alone = lift_of(satin, 0.7);
    CounterRng rng(2, Purpose::test, 0, 0);
    std::vector<double> start;
    for (size_t k = 0; k < alone.size(); ++k)
        start.push_back(50 * rng.uniform());
    const std::vector<double> led =
        crossing_lift(separations(satin), satin.ends, satin.picks, 0.7, start);
    for (size_t k = 0; k < alone.size(); ++k)
        EXPECT_NEAR(led[k], alone[k], 1e-3 * kApart);
}

} // namespace
} // namespace rapport
