#include "renderer/core/error.h"
#include "renderer/core/math.h"
#include "tests/support/scattering.h"
#include "vgsp/weave.h"
#include "vgsp/yarn_system.h"

#include <algorithm>
#include <gtest/gtest.h>

namespace rapport {
namespace {

YarnSystems systems_of(const Cloth& cloth) { return lay_systems(cloth, cloth.draft); }

Cloth satin(double ends_per_cm = 36, double balance = 0.5) {
    YarnSpec warp;
    warp.fibres = 19;
    warp.width_um = 110;
    warp.height_um = 90;
    warp.fibre.diameter_um = 18;
    YarnSpec weft = warp;
    weft.fibres = 12;
    weft.width_um = 140;
    weft.height_um = 60;
    weft.fibre.diameter_um = 16;
    Cloth cloth = tests::cloth_of(named_weave("satin 5/2"), warp, weft, ends_per_cm, 30);
    cloth.crimp_balance = balance;
    return cloth;
}

YarnAxis::Point over_crossing(const YarnSystem& system, size_t yarn, size_t crossing,
                              double spacing) {
    const YarnAxis& axis = system.axes[yarn];
    double low = 0, high = axis.length();
    for (int step = 0; step < 60; ++step) {
        const double middle = 0.5 * (low + high);
        (axis.at(middle).along < (crossing + 0.5) * spacing ? low : high) = middle;
    }
    return axis.at(high);
}

/// The axes' distance across two straight axes, from the heights and slopes at which they cross:
/// of cylinders of these half sizes there should be as much room.
double room(const SystemYarn& warp, const YarnAxis::Point& end, const SystemYarn& weft,
            const YarnAxis::Point& pick) {
    const glm::dvec3 along_end(0, std::cos(end.slope), std::sin(end.slope));
    const glm::dvec3 along_pick(std::cos(pick.slope), 0, std::sin(pick.slope));
    const glm::dvec3 normal = normalize(cross(along_pick, along_end));
    const auto reach = [&](const SystemYarn& yarn, const glm::dvec3& along) {
        const glm::dvec3 across = normalize(cross(along, {0, 0, 1})), up = cross(across, along);
        return std::hypot(yarn.half_width() * dot(normal, across),
                          yarn.half_height() * dot(normal, up));
    };
    return std::abs((end.height - pick.height) * normal.z) - reach(warp, along_end) -
           reach(weft, along_pick);
}

TEST(YarnSettling, YarnsTouchAtEveryCrossingHoweverInclined) {
    for (double balance : {0.2, 0.5, 0.8}) {
        const Cloth cloth = satin(36, balance);
        const auto [warp, weft] = systems_of(cloth);
        double steepest = 0;
        for (size_t end = 0; end < 5; ++end)
            for (size_t pick = 0; pick < 5; ++pick) {
                const YarnAxis::Point e = over_crossing(warp, end, pick, weft.spacing),
                                      p = over_crossing(weft, pick, end, warp.spacing);
                EXPECT_EQ(e.height > p.height, cloth.draft.up(int(end), int(pick)));
                EXPECT_NEAR(room(warp.yarn(end), e, weft.yarn(pick), p), 0, 0.1);
                steepest = std::max({steepest, std::abs(e.slope), std::abs(p.slope)});
            }
        EXPECT_GT(steepest, radians(5.0)); // so that slopes count
    }
}

TEST(YarnSettling, FloatsOfSatinHaveAThirdHeight) {
    const Cloth cloth = satin();
    const auto [warp, weft] = systems_of(cloth);
    std::vector<double> heights;
    for (size_t pick = 0; pick < 5; ++pick)
        heights.push_back(over_crossing(warp, 0, pick, weft.spacing).height);
    std::ranges::sort(heights);
    EXPECT_GT(heights[1] - heights[0], 20);
    EXPECT_NEAR(heights[2], heights[1], 1e-3);
    EXPECT_GT(heights[3] - heights[2], 20);
    EXPECT_NEAR(heights[4], heights[3], 1e-3);

    Cloth twill = cloth;
    twill.draft = named_weave("twill 3/1 Z");
    const YarnSystems flat = systems_of(twill);
    EXPECT_NEAR(flat.warp.axes[0].highest(), 75.0 / 2, 1e-6);
    EXPECT_NEAR(flat.warp.axes[0].lowest(), -75.0 / 2, 1e-6);
}

// Of a stiff weft, lifted floats need more room than straight ones: they are lifted less in a close
// sett.
TEST(YarnSettling, FloatsAreLiftedAsFarAsTheSettHasRoom) {
    const auto height = [](double sett) {
        Cloth cloth = satin(sett, 0.8);
        cloth.picks_per_cm = 53;
        cloth.weft.width_um = cloth.weft.height_um = 76;
        const YarnSystems systems = systems_of(cloth);
        const YarnAxis& pick = systems.weft.axes[0];
        return pick.highest() - pick.lowest();
    };
    const double open = height(30);
    double last = open, sett = 30;
    std::string refusal;
    for (; refusal.empty(); sett += 0.5)
        try {
            EXPECT_LT(height(sett), last + 0.5);
            last = height(sett);
        } catch (const FileError& error) {
            refusal = error.what();
        }
    EXPECT_LT(last, 0.9 * open);
    EXPECT_NE(refusal.find("ends_per_cm: expected at most "), std::string::npos) << refusal;
    const double most = std::stod(refusal.substr(refusal.find("at most ") + 8));
    EXPECT_GT(most, sett - 1.5);
    EXPECT_LT(height(most), 0.9 * open);
}

// Of yarns as stiff as one another it is straight floats that need more.
TEST(YarnSettling, RefusesWhatNoLiftHasRoomFor) {
    double sett = 30;
    std::string refusal;
    for (; refusal.empty(); sett += 0.5)
        try {
            Cloth cloth = satin(sett);
            cloth.weft.height_um = 120;
            systems_of(cloth);
        } catch (const FileError& error) {
            refusal = error.what();
        }
    const double most = std::stod(refusal.substr(refusal.find("at most ") + 8));
    EXPECT_NEAR(most, sett - 1, 1.1);
}

} // namespace
} // namespace rapport
