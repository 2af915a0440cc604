#include "renderer/core/bands.h"

#include <gtest/gtest.h>
#include <limits>
#include <numeric>

using namespace rapport;

namespace {

Rgb sum(const std::vector<Rgb>& weights) {
    return std::accumulate(weights.begin(), weights.end(), Rgb(0));
}

void expect_near(const Rgb& a, const Rgb& b, float tolerance) {
    for (int c = 0; c < 3; ++c)
        EXPECT_NEAR(a[c], b[c], tolerance) << "channel " << c;
}

std::vector<double> edges(double from, double to, double step) {
    std::vector<double> edges;
    for (double nm = from; nm < to + step / 2; nm += step)
        edges.push_back(nm);
    return edges;
}

} // namespace

TEST(Bands, DefaultIsRgb) {
    const Bands bands;
    EXPECT_EQ(bands.count(), 3u);
    EXPECT_TRUE(bands.is_rgb());
    EXPECT_EQ(bands.to_rgb(), (std::vector<Rgb>{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}));
}

TEST(Bands, WhiteIsWhiteHoweverItIsDivided) {
    for (const std::vector<double>& nm :
         {edges(380, 780, 400), edges(380, 780, 100), edges(380, 780, 5), edges(400, 700, 10),
          edges(450, 550, 50), edges(300, 2500, 100), edges(900, 1100, 50), edges(1500, 2000, 500)})
        expect_near(sum(Bands::from_edges(nm).to_rgb()), Rgb(1), 1e-4f);
}

TEST(Bands, NamesAndEdges) {
    const Bands bands = Bands::from_edges({400, 500.5, 700});
    EXPECT_EQ(bands.count(), 2u);
    EXPECT_FALSE(bands.is_rgb());
    EXPECT_EQ(bands.names[0], "400-500.5nm");
    EXPECT_EQ(bands, Bands::from_edges({400, 500.5, 700}));
    const double nan = std::numeric_limits<double>::quiet_NaN();
    for (const std::vector<double>& wrong :
         {std::vector<double>{}, {400}, {400, 400}, {500, 400}, {-1, 400}, {0, 400}, {400, nan}})
        EXPECT_THROW(Bands::from_edges(wrong), std::invalid_argument);
}

// The colour matching functions themselves, as the CIE tabulates them every 100 nm and at the peak
// of y: the fit is good to about 0.02. What to_rgb gives is divided by the totals over all bands
// (106.9 nm each for 380 to 780 nm, by the CIE's table) and adapted to D65, both of which are
// linear: undone here.
TEST(Bands, FollowTheCieFunctions) {
    const std::vector<double> nm = edges(380, 780, 1);
    const std::vector<Rgb> weights = Bands::from_edges(nm).to_rgb();
    const glm::dmat3 xyz_from_rgb = glm::transpose(
        glm::dmat3(0.4124, 0.3576, 0.1805, 0.2126, 0.7152, 0.0722, 0.0193, 0.1192, 0.9505));
    const glm::dmat3 bradford = glm::transpose(
        glm::dmat3(0.8951, 0.2664, -0.1614, -0.7502, 1.7135, 0.0367, 0.0389, -0.0685, 1.0296));
    const glm::dvec3 d65 = xyz_from_rgb * glm::dvec3(1);
    const auto functions_at = [&](int wavelength) {
        const glm::dvec3 cone = bradford * (xyz_from_rgb * glm::dvec3(weights[wavelength - 380]));
        const glm::dvec3 gain = (bradford * glm::dvec3(1)) / (bradford * d65);
        return glm::inverse(bradford) * (gain * cone) * 106.9;
    };
    const auto expect_functions = [&](int wavelength, double x, double y, double z) {
        const glm::dvec3 found = functions_at(wavelength);
        EXPECT_NEAR(found.x, x, 0.03) << wavelength;
        EXPECT_NEAR(found.y, y, 0.03) << wavelength;
        EXPECT_NEAR(found.z, z, 0.05) << wavelength;
    };
    expect_functions(450, 0.3362, 0.0380, 1.7721);
    expect_functions(500, 0.0049, 0.3230, 0.2720);
    expect_functions(555, 0.5121, 1.0000, 0.0057);
    expect_functions(600, 1.0622, 0.6310, 0.0008);
    expect_functions(650, 0.2835, 0.1070, 0.0000);
    // The wrong twin: the same values one band of 10 nm further would be seen.
    EXPECT_GT(std::abs(functions_at(510).y - 0.3230), 0.1);
}

TEST(Bands, PrimariesComeFromWhereTheyShould) {
    const std::vector<Rgb> weights = Bands::from_edges({380, 490, 580, 780}).to_rgb();
    EXPECT_GT(weights[0].b, weights[0].r + 0.5f);
    EXPECT_GT(weights[1].g, weights[1].r + 0.5f);
    EXPECT_GT(weights[2].r, weights[2].b + 0.5f);
}

TEST(Luminance, OfWhiteIsOne) { EXPECT_NEAR(luminance(Rgb(1)), 1, 1e-6); }
