#include "renderer/core/math.h"
#include "vgsp/yarn_axis.h"

#include <algorithm>
#include <gtest/gtest.h>

namespace rapport {
namespace {

using glm::dvec2;

const std::vector<uint8_t> kPlain{1, 0}, kTwill{1, 1, 0, 0}, kSatin{1, 1, 1, 1, 0},
    kUneven{1, 0, 0, 1, 0, 1, 1};

dvec2 position(const YarnAxis& axis, double s) {
    const YarnAxis::Point p = axis.at(s);
    return {p.along, p.height};
}

/// A yarn in Peirce's geometry: own and crossed half sizes, the spacing and its share of crimp.
struct Setting {
    SectionOutline crossed{60, 60};
    double own_half_height = 50;
    double spacing = 260;
    double share = 0.5;

    double both() const { return 2 * (crossed.half_height + own_half_height); }
    WrapCurve wrap() const { return {crossed, own_half_height}; }
    YarnAxis axis(const std::vector<uint8_t>& above) const {
        const auto about = std::make_shared<WrapArc>(wrap());
        std::vector<YarnAxis::Crossing> crossings;
        for (size_t k = 0; k < above.size(); ++k)
            crossings.push_back({above[k] != 0, centre(above, int(k)).y, about});
        return {crossings, spacing};
    }
    /// The centre of the crossed section k.
    dvec2 centre(const std::vector<uint8_t>& above, int k) const {
        const bool up = above[size_t(k + 10 * int(above.size())) % above.size()];
        return {(k + 0.5) * spacing, (up ? -0.5 : 0.5) * (1 - share) * both()};
    }
};

/// Distance of a point outside the ellipse from it: the best of many points, then of finer steps.
double distance_to_ellipse(dvec2 p, SectionOutline e) {
    const auto distance = [&](double t) {
        return length(p - dvec2(e.half_width * std::cos(t), e.half_height * std::sin(t)));
    };
    double best = 0;
    for (double t = 0; t < 2 * kPi; t += 0.02)
        if (distance(t) < distance(best))
            best = t;
    for (double step = 0.02; step > 1e-8; step /= 2)
        for (double t : {best - step, best + step})
            if (distance(t) < distance(best))
                best = t;
    return distance(best);
}

/// The height of the axis over `along`.
double height_at(const YarnAxis& axis, double along) {
    double low = -axis.length(), high = 2 * axis.length();
    for (int step = 0; step < 60; ++step) {
        const double middle = 0.5 * (low + high);
        (axis.at(middle).along < along ? low : high) = middle;
    }
    return axis.at(high).height;
}

TEST(YarnAxis, LengthOfPlainWeaveIsTheClosedForm) {
    for (double share : {0.2, 0.5, 0.9}) {
        Setting cloth;
        cloth.share = share;
        const double d = 110, crossed_crimp = (1 - share) * 2 * d;
        const double centres = std::hypot(cloth.spacing, crossed_crimp);
        const double theta = std::asin(2 * d / centres) - std::atan2(crossed_crimp, cloth.spacing);
        const double length = 2 * (2 * d * theta + std::sqrt(centres * centres - 4 * d * d));
        const YarnAxis axis = cloth.axis(kPlain);
        EXPECT_NEAR(axis.length(), length, 1e-9 * length);
        EXPECT_NEAR(axis.turn(), 4 * theta, 1e-9);
        EXPECT_DOUBLE_EQ(axis.period(), 2 * cloth.spacing);
        EXPECT_NEAR(axis.smallest_curvature_radius(), d, 1e-9);
    }
}

TEST(YarnAxis, RunsOnCirclesAboutTheCrossedSections) {
    const Setting cloth;
    const YarnAxis axis = cloth.axis(kTwill);
    int touching = 0;
    for (double s = 0.37; s < axis.length(); s += 1) {
        double nearest = 1e9;
        for (int k = -1; k < 5; ++k)
            nearest = std::min(nearest, length(position(axis, s) - cloth.centre(kTwill, k)));
        EXPECT_GT(nearest, 110 - 1e-9);
        touching += nearest < 110 + 1e-9;
    }
    // Four arcs of radius 110: twice two crossings, half a wrap each.
    EXPECT_NEAR(touching, axis.turn() * 110, 5);
}

TEST(YarnAxis, TouchesTheCrossedAxisAtEveryCrossing) {
    for (double share : {0.0, 0.3, 1.0}) {
        Setting warp;
        warp.share = share;
        Setting weft{{50, 50}, 60, 300, 1 - share};
        const YarnAxis warp_axis = warp.axis(kUneven);
        for (size_t k = 0; k < kUneven.size(); ++k) {
            // The crossed yarn passes on the other side, at some crossing of its own.
            const std::vector<uint8_t> opposite{uint8_t(!kUneven[k]), kUneven[k]};
            const YarnAxis weft_axis = weft.axis(opposite);
            const double warp_height = height_at(warp_axis, (k + 0.5) * warp.spacing);
            const double weft_height = height_at(weft_axis, 0.5 * weft.spacing);
            EXPECT_NEAR(warp_height - weft_height, kUneven[k] ? 110 : -110, 1e-6);
        }
    }
}

TEST(YarnAxis, IsSmoothAndMeasuredByArcLength) {
    Setting flat{{120, 35}, 40, 300, 0.4};
    for (const Setting& cloth : {Setting(), flat})
        for (const auto& above : {kPlain, kTwill, kSatin, kUneven}) {
            const YarnAxis axis = cloth.axis(above);
            const double h = 1e-3;
            for (double s = -20; s < axis.length() + 20; s += 1.731) {
                const dvec2 step = (position(axis, s + h) - position(axis, s - h)) / (2 * h);
                const double slope = axis.at(s).slope;
                EXPECT_NEAR(length(step), 1, 1e-6);
                // Half a step's turn where an arc ends within it.
                EXPECT_NEAR(std::atan2(step.y, step.x), slope, 1e-5);
            }
        }
}

TEST(YarnAxis, RepeatsExactly) {
    for (const auto& above : {kPlain, kSatin, kUneven}) {
        const YarnAxis axis = Setting().axis(above);
        EXPECT_NEAR(axis.at(0).along, 0, 1e-9);
        for (double s = 0; s < axis.length(); s += 7.3)
            for (int repeats : {-2, 1, 3}) {
                const YarnAxis::Point a = axis.at(s), b = axis.at(s + repeats * axis.length());
                EXPECT_NEAR(b.along - a.along, repeats * axis.period(), 1e-8);
                EXPECT_NEAR(b.height, a.height, 1e-8);
                EXPECT_NEAR(b.slope, a.slope, 1e-8);
            }
    }
}

TEST(YarnAxis, FloatsAreStraight) {
    const Setting cloth;
    const YarnAxis axis = cloth.axis(kSatin);
    int floating = 0;
    for (double s = 0; s < axis.length(); s += 1) {
        const YarnAxis::Point p = axis.at(s);
        if (p.along < 0.5 * cloth.spacing || p.along > 3.5 * cloth.spacing)
            continue;
        EXPECT_NEAR(p.height, 0.25 * cloth.both(), 1e-9);
        EXPECT_NEAR(p.slope, 0, 1e-12);
        ++floating;
    }
    EXPECT_NEAR(floating, 3 * cloth.spacing, 2);
}

TEST(YarnAxis, FlattenedYarnsRunAtTheirHalfHeightFromTheEllipse) {
    for (SectionOutline crossed : {SectionOutline{110, 40}, SectionOutline{40, 70}}) {
        const Setting cloth{crossed, 35, 320, 0.6};
        const YarnAxis axis = cloth.axis(kUneven);
        int touching = 0;
        for (double s = 0; s < axis.length(); s += 5) {
            double nearest = 1e9;
            for (int k = -1; k < 8; ++k)
                nearest = std::min(
                    nearest,
                    distance_to_ellipse(position(axis, s) - cloth.centre(kUneven, k), crossed));
            EXPECT_GT(nearest, 35 - 1e-6);
            touching += nearest < 35 + 1e-6;
        }
        EXPECT_GT(touching, 10);
        EXPECT_NEAR(position(axis, 0).x, 0, 1e-6);
    }
}

TEST(YarnAxis, IsStraightWithoutAShareOfTheCrimp) {
    Setting cloth;
    cloth.share = 0;
    const YarnAxis axis = cloth.axis(kPlain);
    EXPECT_NEAR(axis.length(), axis.period(), 1e-9);
    for (double s = 0; s < axis.length(); s += 10)
        EXPECT_NEAR(axis.at(s).height, 0, 1e-6);
}

TEST(YarnAxis, MeanSlopeIsTheAverage) {
    const YarnAxis axis = Setting{{90, 40}, 40, 300, 0.4}.axis(kUneven);
    for (double s = -50; s < axis.length(); s += 13.7) {
        EXPECT_EQ(axis.mean_slope(s, 0), axis.at(s).slope);
        double mean = 0;
        for (int k = 0; k < 1000; ++k)
            mean += axis.at(s + 60 * ((k + 0.5) / 1000 - 0.5)).slope / 1000;
        EXPECT_NEAR(axis.mean_slope(s, 60), mean, 1e-5);
    }
}

WrapPassage down(const WrapCurve& curve, double rise) {
    return {{&curve, true}, {&curve, false}, rise};
}

TEST(YarnAxis, SmallestSpacingIsWhereTheLineVanishes) {
    const WrapCurve circle({60, 60}, 50);
    for (double crimp : {0.0, 80.0, 150.0, 220.0})
        EXPECT_NEAR(down(circle, crimp).smallest_spacing(), std::sqrt(220 * 220 - crimp * crimp),
                    1e-4);

    for (SectionOutline crossed : {SectionOutline{60, 60}, SectionOutline{100, 40}}) {
        Setting cloth{crossed, 50, 0, 0.4};
        cloth.spacing = down(cloth.wrap(), 0.6 * cloth.both()).smallest_spacing();
        const YarnAxis axis = cloth.axis(kPlain);
        for (double s = 0; s < axis.length(); s += 0.5)
            EXPECT_NEAR(length(position(axis, s + 0.5) - position(axis, s)), 0.5, 1e-4);
        cloth.spacing *= 1 - 1e-6;
        EXPECT_THROW(cloth.axis(kPlain), std::invalid_argument);
        EXPECT_NO_THROW(cloth.axis({1, 1})); // a float needs no room between the crossed yarns
    }
}

// The angles that a line makes with the centres', whether these rise or fall.
TEST(YarnAxis, LinesTouchCirclesAsTheClosedFormsSay) {
    const WrapCurve small({60, 60}, 50), large({90, 90}, 50);
    const double spacing = 400;
    for (double rise : {-200.0, -40.0, 0.0, 90.0, 230.0, 500.0}) {
        const double apart = std::hypot(spacing, rise), centres = std::atan2(rise, spacing);
        for (const auto& [a, b] : {std::pair(&small, &small), {&small, &large}, {&large, &small}}) {
            const double from = a->support(0), to = b->support(0);
            EXPECT_NEAR(WrapPassage({a, true}, {b, true}, rise).slope(spacing),
                        centres + std::asin((to - from) / apart), 1e-12);
            EXPECT_NEAR(WrapPassage({a, false}, {b, false}, rise).slope(spacing),
                        centres - std::asin((to - from) / apart), 1e-12);
            const double across = std::asin((from + to) / apart);
            const WrapPassage falls({a, true}, {b, false}, rise),
                rises({a, false}, {b, true}, rise);
            if (centres - across > -kPi / 2) {
                EXPECT_NEAR(falls.slope(spacing), centres - across, 1e-12) << rise;
            }
            if (centres + across < kPi / 2) {
                EXPECT_NEAR(rises.slope(spacing), centres + across, 1e-12) << rise;
            }
        }
    }
    // A line that would turn back is none: it needs the sections' whole widths.
    EXPECT_NEAR(down(small, -300).smallest_spacing(), 220, 1e-9);
    EXPECT_NEAR(down(small, -300).slope(220), -kPi / 2, 1e-6);
    EXPECT_EQ(down(small, 250).smallest_spacing(), 0);
}

// A float over yarns that stand at different heights is the string drawn over them: it touches
// those that stand out and is clear of the others.
TEST(YarnAxis, FloatsAreDrawnOverTheHighest) {
    const Setting cloth;
    const std::vector<double> centres{60, -20, 15, 0, 12, -60};
    const auto about = std::make_shared<WrapArc>(cloth.wrap());
    std::vector<YarnAxis::Crossing> crossings;
    for (const double centre : centres)
        crossings.push_back({!crossings.empty(), centre, about});
    const YarnAxis axis(crossings, cloth.spacing);

    // Wherever the repeat begins, the same axis.
    for (int begin = 1; begin < 6; ++begin) {
        std::rotate(crossings.begin(), crossings.begin() + 1, crossings.end());
        const YarnAxis moved(crossings, cloth.spacing);
        EXPECT_NEAR(moved.length(), axis.length(), 1e-9);
        for (double along = 10; along < axis.period(); along += 97)
            EXPECT_NEAR(height_at(moved, along), height_at(axis, along + begin * cloth.spacing),
                        1e-6);
    }

    std::vector<double> nearest(centres.size(), HUGE_VAL);
    for (double s = 0; s < axis.length(); s += 0.5)
        for (int k = -1; k < 7; ++k) {
            double& least = nearest[size_t(k + 6) % 6];
            const dvec2 centre((k + 0.5) * cloth.spacing, centres[size_t(k + 6) % 6]);
            least = std::min(least, length(position(axis, s) - centre));
        }
    for (size_t k = 0; k < centres.size(); ++k)
        EXPECT_NEAR(nearest[k], k == 3 ? 110 + 13.5 : 110, 0.02) << k;

    // Circles of one size: lines as steep as those between the centres.
    const auto slope = [&](double rise, int intervals) {
        return std::atan(rise / (intervals * cloth.spacing));
    };
    const std::vector<double> expected{
        0, slope(35, 1), 0, slope(-3, 2), slope(-3, 2), slope(-72, 1)};
    for (size_t k = 0; k < centres.size(); ++k)
        EXPECT_NEAR(axis.crossing_slopes()[k], expected[k], 1e-9) << k;
    EXPECT_NEAR(axis.highest(), 15 + 110, 1e-9);
    EXPECT_NEAR(axis.lowest(), 60 - 110, 1e-9);
}

} // namespace
} // namespace rapport
