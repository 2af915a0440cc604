#include "vgsp/crossing_heights.h"

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

CrossingHeights heights_of(const Draft& draft, double balance) {
    return crossing_heights(separations(draft), draft.ends, draft.picks, balance);
}

/// The largest force that is left at a crossing of unequal stiffnesses, flatness included.
double imbalance(const CrossingHeights& heights, const std::vector<double>& apart, int ends,
                 int picks, double balance) {
    double largest = 0;
    for (int end = 0; end < ends; ++end)
        for (int pick = 0; pick < picks; ++pick) {
            const size_t here = size_t(end * picks + pick);
            double force = 1e-3 * (heights.warp[here] - balance * apart[here]);
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

TEST(CrossingHeights, ArePeircesInPlainWeaveAndTwills) {
    for (const char* weave : {"plain", "twill 2/2 Z", "twill 3/1 S", "twill 2/1 Z", "basket 2"})
        for (double balance : {0.0, 0.3, 0.5, 1.0}) {
            const Draft draft = named_weave(weave);
            const CrossingHeights heights = heights_of(draft, balance);
            const std::vector<double> apart = separations(draft);
            for (size_t k = 0; k < apart.size(); ++k) {
                EXPECT_NEAR(heights.warp[k], balance * apart[k], 1e-6) << weave;
                EXPECT_NEAR(heights.weft[k], (balance - 1) * apart[k], 1e-6) << weave;
            }
        }
}

// By hand, for a satin of five in steps of two in equally stiff threads: a thread's heights over a
// repeat are ∓1/2, ±1/6, ±5/6, ±5/6 and ±1/6 of the separation.
TEST(CrossingHeights, InSatinTheMiddleOfFloatsIsLifted) {
    const Draft satin = named_weave("satin 5/2");
    const CrossingHeights heights = heights_of(satin, 0.5);
    const std::array<double, 5> of_end{-1.0 / 2, 1.0 / 6, 5.0 / 6, 5.0 / 6, 1.0 / 6};
    for (int end = 0; end < 5; ++end) {
        int under = 0;
        while (satin.up(end, under))
            ++under;
        for (int k = 0; k < 5; ++k)
            EXPECT_NEAR(heights.warp[size_t(end * 5 + (under + k) % 5)], of_end[k] * kApart, 0.1);
    }
}

TEST(CrossingHeights, AreInBalanceForAnyDraft) {
    CounterRng rng(1, Purpose::test, 0, 0);
    for (const auto& [ends, picks] : {std::pair(12, 17), {2, 31}, {60, 50}})
        for (double balance : {1e-3, 0.5, 0.9}) {
            std::vector<double> apart;
            for (int k = 0; k < ends * picks; ++k)
                apart.push_back((rng.uniform() < 0.5 ? -1 : 1) * (50 + 60 * rng.uniform()));
            const CrossingHeights heights = crossing_heights(apart, ends, picks, balance);
            for (size_t k = 0; k < apart.size(); ++k)
                EXPECT_NEAR(heights.warp[k] - heights.weft[k], apart[k], 1e-9);
            EXPECT_LT(imbalance(heights, apart, ends, picks, balance), 1e-2);
            CrossingHeights shared; // as Peirce's heights would be, which these are not
            for (const double d : apart) {
                shared.warp.push_back(balance * d);
                shared.weft.push_back((balance - 1) * d);
            }
            EXPECT_GT(imbalance(shared, apart, ends, picks, balance), 1);
        }
}

} // namespace
} // namespace rapport
