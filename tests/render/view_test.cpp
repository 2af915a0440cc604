#include "renderer/preview/session.h"
#include "tests/support/run_program.h"
#include "tests/support/sessions.h"

#include <cstdlib>
#include <set>
#include <stb/stb_image.h>

// The window itself, on a display without a screen.

namespace rapport {
namespace {

/// Without a display and OpenGL by software there is nothing to test.
bool has_virtual_display() {
    return std::system("command -v xvfb-run >/dev/null && command -v xauth >/dev/null") == 0;
}

tests::ProgramRun run_on_virtual_display(const std::vector<std::string>& arguments) {
    std::vector<std::string> all{"-a", "-s", "-screen 0 1280x1024x24", RAPPORT_PROGRAM};
    all.insert(all.end(), arguments.begin(), arguments.end());
    return tests::run_executable("xvfb-run", all);
}

TEST(View, ShowsThePictureBetweenItsPanels) {
    if (!has_virtual_display())
        GTEST_SKIP() << "xvfb-run and xauth (Debian: xvfb, xauth) are not here";
    const tests::SquareScene files(tests::SquareScene::Worn::measured);
    const std::string screenshot = (files / "window.png").string();
    const tests::ProgramRun run =
        run_on_virtual_display({"view", files.scene().string(), "--size", "900x600", "--frames",
                                "25", "--screenshot", screenshot});
    ASSERT_EQ(run.status, 0) << run.err;
    EXPECT_EQ(run.err, "");
    int width, height, channels;
    const std::unique_ptr<uint8_t, void (*)(void*)> pixels(
        stbi_load(screenshot.c_str(), &width, &height, &channels, 3), stbi_image_free);
    ASSERT_TRUE(pixels);
    EXPECT_EQ(width, 900);
    EXPECT_EQ(height, 600);
    // The sky has one radiance, here at the upper edge, and the cloth in the middle is darker.
    const auto pixel = [&](int x, int y) {
        const uint8_t* p = pixels.get() + 3 * (y * width + x);
        return glm::ivec3(p[0], p[1], p[2]);
    };
    EXPECT_EQ(pixel(450, 5), glm::ivec3(188, 188, 203)); // 0.5, 0.5 and 0.6 under the sRGB curve
    EXPECT_NE(pixel(450, 300), pixel(450, 5));
    std::set<int> greys; // of the panels' text and controls
    for (int y = 0; y < height; ++y)
        greys.insert(pixel(60, y).x);
    EXPECT_GT(greys.size(), 5u);
}

TEST(View, SaysWhereThereIsNoDisplay) {
    const tests::SquareScene files(tests::SquareScene::Worn::stored);
    const tests::ProgramRun run =
        tests::run_executable("env", {"-u", "DISPLAY", "-u", "WAYLAND_DISPLAY", RAPPORT_PROGRAM,
                                      "view", files.scene().string(), "--frames", "1"});
    EXPECT_EQ(run.status, 2);
    EXPECT_NE(run.err.find("expected a display"), std::string::npos) << run.err;
    EXPECT_EQ(std::ranges::count(run.err, '\n'), 1) << run.err;
}

} // namespace
} // namespace rapport
