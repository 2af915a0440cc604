#include "renderer/core/srgb.h"
#include "renderer/integrator/streaks.h"
#include "renderer/preview/tone.h"

#include <algorithm>
#include <cmath>
#include <gtest/gtest.h>
#include <limits>

namespace rapport {
namespace {

Image picture(const std::vector<float>& red) {
    Image image(static_cast<int>(red.size()), 1,
                {"R", "G", "B", "N.X", "N.Y", "N.Z", "variance.R", "variance.G", "variance.B"});
    *image.find("R") = red;
    return image;
}

TEST(Tone, IsTheSrgbCurveToOneStep) {
    std::vector<float> values;
    for (int i = 0; i <= 1000; ++i)
        values.push_back(1.2f * i / 1000);
    const std::vector<uint8_t> bytes = displayed(picture(values), {}, {});
    for (size_t i = 0; i < values.size(); ++i)
        EXPECT_NEAR(bytes[4 * i], 255 * encode_srgb(std::min(values[i], 1.0f)), 1.0) << values[i];
    EXPECT_EQ(bytes[3], 255);
}

TEST(Tone, ExposureIsInStops) {
    const std::vector<uint8_t> plain = displayed(picture({0.4f}), {}, {});
    Tone brighter;
    brighter.exposure = 2;
    EXPECT_EQ(displayed(picture({0.1f}), {}, brighter)[0], plain[0]);
}

TEST(Tone, TheFilmCurveRisesAndKeepsHighlights) {
    Tone film;
    film.curve = ToneCurve::film;
    const std::vector<uint8_t> bytes = displayed(picture({0, 0.1f, 0.5f, 1, 2, 4}), {}, film);
    for (size_t i = 4; i < bytes.size(); i += 4)
        EXPECT_GT(bytes[i], bytes[i - 4]);
    EXPECT_LT(bytes[4 * 3], 240); // 1 is not white yet
}

TEST(Tone, WhatIsNoNumberIsBlack) {
    const float nan = std::numeric_limits<float>::quiet_NaN();
    EXPECT_EQ(displayed(picture({nan, -1}), {}, {})[0], 0);
    EXPECT_EQ(displayed(picture({nan, -1}), {}, {})[4], 0);
    Tone noise;
    noise.layer = Layer::variance;
    EXPECT_EQ(displayed(picture({0.5f}), {}, noise)[0], 0);
}

TEST(Tone, NormalsAreColours) {
    Image image = picture({0, 0});
    (*image.find("N.Z"))[0] = 1;
    Tone normals;
    normals.layer = Layer::normals;
    const std::vector<uint8_t> bytes = displayed(image, {}, normals);
    EXPECT_EQ(bytes[0], 128);
    EXPECT_EQ(bytes[2], 255);
    EXPECT_EQ(bytes[4], 0); // nothing is there
}

TEST(Tone, TheWarpIsTheStreaksOfTheOfflineRender) {
    Camera camera;
    camera.kind = Camera::Kind::orthographic;
    camera.resolution = {16, 8};
    Image image(16, 8, {"R", "G", "B", "N.X", "N.Y", "N.Z", "warp.X", "warp.Y", "warp.Z", "Z"});
    for (const char* one : {"N.Z", "warp.X", "Z"})
        image.find(one)->assign(16 * 8, 1);
    (*image.find("Z"))[5] = 0; // nothing there
    Tone warp;
    warp.layer = Layer::warp;
    const std::vector<uint8_t> bytes = displayed(image, camera, warp);
    const Image streaks = warp_streaks(image, camera);
    for (size_t i = 0; i < 16 * 8; ++i)
        EXPECT_NEAR(bytes[4 * i + 2], 255 * encode_srgb((*streaks.find("B"))[i]), 1.0) << i;
    EXPECT_EQ(bytes[4 * 5], 0);
}

} // namespace
} // namespace rapport
