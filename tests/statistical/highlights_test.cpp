#include "vgsp/plane_scan.h"

#include "tests/support/highlights.h"
#include "tests/support/long_run.h"

#include <cstdio>
#include <gtest/gtest.h>

// Cloths built from sett, yarn sizes and crimp against the highlights of real ones. No inclination
// is typed in: the yarns' geometry makes them. The bounds are the measured lobes' own.

namespace rapport {
namespace {

using tests::Highlight, tests::highlights, tests::MeasuredCloth;

const uint64_t kPaths = tests::long_run() ? 8'000'000 : 4'000'000;
constexpr double kAlongWarp = kPi / 2, kAlongWeft = 0;

Cloth our_cloth(const char* name) {
    return read_cloth(std::string(RAPPORT_SOURCE_DIR "/scenes/cloths/") + name + ".toml");
}

/// Prints how far each highlight is from the nearest measured one.
void print_residuals(const MeasuredCloth& measured, const std::vector<Highlight>& found) {
    for (const Highlight& highlight : found) {
        double nearest = HUGE_VAL;
        for (const double inclination : measured.inclinations)
            if (const double residual = highlight.angle - measured.exit(inclination);
                std::abs(residual) < std::abs(nearest))
                nearest = residual;
        std::printf("%s: highlight at ±%.1f°, %.1f° from the measured one; deviation %.1f° "
                    "(measured %.0f° to %.0f°), contrast %.1f\n",
                    measured.name, highlight.angle, nearest, highlight.width, measured.narrowest(),
                    measured.widest(), highlight.contrast);
    }
}

/// Whether there is one highlight at each of the angles and no other, each nearer than one standard
/// deviation of the measured lobe's narrower part, no broader than its wider part, and no sharper
/// than three quarters of the sharpest lobe of all that were measured. (That cannot be told of one
/// less than twice as high as its ground, on the flank of another: half its height is its tip.)
bool agrees(const MeasuredCloth& measured, const std::vector<double>& angles,
            const std::vector<Highlight>& found) {
    constexpr double kStandsClear = 2;
    if (found.size() != angles.size())
        return false;
    for (size_t i = 0; i < angles.size(); ++i)
        if (std::abs(found[i].angle - angles[i]) > measured.narrowest() ||
            found[i].width > measured.widest() ||
            (found[i].contrast >= kStandsClear &&
             found[i].width < 0.75 * tests::kSatinCharmeuse.narrowest()))
            return false;
    return true;
}

TEST(Highlights, OfSilkCharmeuseAreFive) {
    const MeasuredCloth& measured = tests::kSatinCharmeuse;
    const double inner = measured.exit(measured.inclinations[1]);
    const double outer = measured.exit(measured.inclinations.back());
    const Cloth cloth = our_cloth("silk-charmeuse");
    const auto along = highlights(tests::mirror_scan(cloth, kAlongWarp, kPaths));
    print_residuals(measured, along);
    EXPECT_TRUE(agrees(measured, {0, inner, outer}, along));

    // As sharp as images in smooth fibres are, they are not those of the cloth.
    Cloth smooth = cloth;
    smooth.warp.fibre.roughness = smooth.weft.fibre.roughness = 0;
    EXPECT_FALSE(agrees(measured, {0, inner, outer},
                        highlights(tests::mirror_scan(smooth, kAlongWarp, kPaths / 2))));

    EXPECT_FALSE(agrees(measured, {0, inner, outer},
                        highlights(tests::mirror_scan(cloth, kAlongWeft, kPaths / 4))));
    Cloth straight = cloth;
    straight.crimp_balance = 0;
    straight.ends_per_cm = 50; // so that the weft has room to take all crimp
    EXPECT_FALSE(agrees(measured, {0, inner, outer},
                        highlights(tests::mirror_scan(straight, kAlongWarp, kPaths / 4))));
}

TEST(Highlights, OfCrepeDeChineAreTwo) {
    const MeasuredCloth& measured = tests::kCrepeDeChine;
    const double outer = measured.exit(measured.inclinations.back());
    const auto along =
        highlights(tests::mirror_scan(our_cloth("silk-crepe-de-chine"), kAlongWarp, kPaths));
    print_residuals(measured, along);
    EXPECT_TRUE(agrees(measured, {outer}, along));
}

// No peak, but as much light from every slope, and so a BSDF that rises towards the horizon.
TEST(Highlights, OfLinenAreNone) {
    const PlaneScan scan = tests::mirror_scan(our_cloth("linen"), kAlongWarp, kPaths);
    EXPECT_TRUE(highlights(scan).empty());
    double steep = 0, grazing = 0; // BSDF in the mean over angles below 30°, and 70° to 85°
    int steep_bins = 0, grazing_bins = 0;
    for (int bin = 0; bin < PlaneScan::kAngles; ++bin) {
        const double angle = std::abs(PlaneScan::angle(bin));
        const double bsdf = scan.mean_intensity[bin] / std::cos(angle);
        if (angle < radians(30.0))
            steep += bsdf, ++steep_bins;
        else if (angle > radians(70.0) && angle < radians(85.0))
            grazing += bsdf, ++grazing_bins;
    }
    EXPECT_GT(grazing / grazing_bins, 1.5 * steep / steep_bins);
}

} // namespace
} // namespace rapport
