#include "renderer/preview/view.h"
#include "renderer/preview/window.h"
#include "tests/support/sessions.h"
#include "tests/support/virtual_display.h"
#include "tests/support/window_hand.h"

#include <epoxy/gl.h> // before GLFW
// clang-format off
#include <GLFW/glfw3.h>
// clang-format on
#include <backends/imgui_impl_glfw.h>
#include <dlfcn.h>
#include <imgui.h>
#include <link.h>
#include <stb/stb_image.h>

// The window in this process, on a display without a screen: what happens to it between frames.

namespace rapport {
namespace {

using tests::next_picture;
using tests::SquareScene;
using tests::tick_until;
using tests::WindowHand;

/// Lets the libraries of the graphics driver stay until the program ends. What they have allocated
/// is reached from their own variables, and when GLFW had unloaded them it would count as leaked.
void keep_driver() {
    const Window window("driver", {16, 16});
    std::vector<std::string> names;
    const auto add = [](dl_phdr_info* library, size_t, void* to) {
        static_cast<std::vector<std::string>*>(to)->push_back(library->dlpi_name);
        return 0;
    };
    dl_iterate_phdr(add, &names);
    for (const std::string& name : names)
        if (name.find("/dri/") != std::string::npos || name.find("gallium") != std::string::npos)
            dlopen(name.c_str(), RTLD_LAZY | RTLD_NOLOAD | RTLD_NODELETE);
}

class ViewWindow : public testing::Test {
  protected:
    void SetUp() override {
        if (!tests::VirtualDisplay::available())
            GTEST_SKIP() << "Xvfb (Debian: xvfb) is not here";
        display_.emplace();
        keep_driver();
        std::filesystem::current_path(working_.path()); // where unsaved edits are left
    }
    void TearDown() override { std::filesystem::current_path(folder_); }
    static GLFWwindow* window() { return glfwGetCurrentContext(); }

    const std::filesystem::path folder_ = std::filesystem::current_path();
    const tests::TemporaryFolder working_;
    std::optional<tests::VirtualDisplay> display_;
};

glm::ivec2 size_of_png(const std::filesystem::path& file) {
    glm::ivec2 size(0);
    int channels;
    stbi_info(file.c_str(), &size.x, &size.y, &channels);
    return size;
}

/// Until how often graphics drivers are reset is told.
int resets_to_tell = 0;
PFNGLGETGRAPHICSRESETSTATUSPROC driver_answers;

GLenum APIENTRY tells_of_resets() {
    return resets_to_tell-- > 0 ? GL_GUILTY_CONTEXT_RESET : driver_answers();
}

/// Lets the driver tell of so many resets from now on.
void reset_graphics(int times) {
    if (epoxy_glGetGraphicsResetStatus != tells_of_resets)
        driver_answers = std::exchange(epoxy_glGetGraphicsResetStatus, tells_of_resets);
    resets_to_tell = times;
}

TEST_F(ViewWindow, ALostOneIsReplacedAndTheEditedClothSaved) {
    const SquareScene files(SquareScene::Worn::measured);
    std::filesystem::current_path(files.scene().parent_path());
    Session session({files.scene()});
    Cloth edited = *session.documents().at(files.cloth()).cloth;
    edited.ends_per_cm = 17;
    session.edit_cloth(files.cloth(), edited);
    bool reset = false;
    const auto before_frame = [&](int frame) {
        if (frame == 4)
            glfwSetWindowSize(window(), 500, 400);
        if (frame == 8 && !std::exchange(reset, true))
            reset_graphics(1);
    };
    view(session, {400, 300}, {12, files / "after.png", before_frame});
    EXPECT_EQ(size_of_png(files / "after.png"), glm::ivec2(500, 400)); // as the one that is gone
    ASSERT_GE(session.notes().size(), 2u);
    EXPECT_NE(session.notes()[0].find("driver was reset"), std::string::npos);
    EXPECT_EQ(session.notes()[1], "saved cloth-rescued.toml");
    EXPECT_EQ(read_cloth(files / "cloth-rescued.toml").ends_per_cm, 17);
    EXPECT_NE(next_picture(session, 1), nullptr);

    // One that never keeps a picture is given up.
    EXPECT_THROW(view(session, {400, 300}, {12, {}, [](int) { reset_graphics(1); }}), FileError);
}

TEST_F(ViewWindow, WhatNobodySavedIsWrittenWhenItCloses) {
    const SquareScene files(SquareScene::Worn::measured);
    Session session({files.scene()});
    const auto document = [&] { return session.documents().at(files.cloth()); };
    WindowHand idle;
    idle.wait_until([&] { return session.picture() != nullptr; });
    EXPECT_TRUE(idle.use(session).empty());
    EXPECT_FALSE(std::filesystem::exists("cloth-rescued.toml"));

    WindowHand hand;
    hand.point({"cloth", {"ends"}}, {0.1f, 0.5f});
    hand.click();
    hand.wait_until([&] { return document().edited; });
    const std::vector<std::string> notes = hand.use(session);
    ASSERT_EQ(notes.size(), 2u);
    EXPECT_EQ(notes[1], "saved cloth-rescued.toml");
    EXPECT_EQ(read_cloth("cloth-rescued.toml").ends_per_cm, document().cloth->ends_per_cm);
    EXPECT_LT(document().cloth->ends_per_cm, 19);
    EXPECT_EQ(read_cloth(files.cloth()).ends_per_cm, 20); // which is left alone
}

TEST_F(ViewWindow, OutlivesAStormOfSizesAndBeingHidden) {
    const SquareScene files(SquareScene::Worn::stored);
    Session session({files.scene()});
    const auto before_frame = [](int frame) {
        for (int i = 10 * frame; frame < 20 && i < 10 * (frame + 1); ++i)
            glfwSetWindowSize(window(), i % 13 == 0 ? 1 : 1 + 97 * i % 1200,
                              i % 17 == 0 ? 1 : 1 + 53 * i % 900);
        if (frame == 20)
            glfwIconifyWindow(window());
        if (frame == 22)
            glfwHideWindow(window());
        if (frame == 24)
            glfwShowWindow(window());
        if (frame == 25)
            glfwSetWindowSize(window(), 640, 480);
    };
    view(session, {400, 300}, {40, files / "after.png", before_frame});
    EXPECT_EQ(size_of_png(files / "after.png"), glm::ivec2(640, 480));
    EXPECT_EQ(session.error(), "");
    const auto picture = next_picture(session, 1);
    ASSERT_TRUE(picture);
    EXPECT_EQ(picture->image.height, 480);
}

TEST_F(ViewWindow, ThePictureIsTracedWhileItOpens) {
    const SquareScene files(SquareScene::Worn::stored);
    Session session({files.scene()});
    std::vector<uint64_t> views;
    view(session, {900, 600}, {3, {}, [&](int) { views.push_back(session.tracer().latest()); }});
    EXPECT_EQ(views, std::vector<uint64_t>(3, 1)); // begun before, and never begun again
}

TEST_F(ViewWindow, TheMouseTurnsAndTheWheelBringsNearer) {
    const SquareScene files(SquareScene::Worn::measured);
    Session session({files.scene()});
    std::vector<glm::mat4> poses;
    const auto before_frame = [&](int frame) {
        poses.push_back(session.camera().to_world);
        if (frame == 0)
            glfwFocusWindow(window());
        if (frame >= 2)
            glfwSetCursorPos(window(), 300 + 5 * frame, 200);
        if (frame == 4 || frame == 8)
            ImGui_ImplGlfw_MouseButtonCallback(window(), GLFW_MOUSE_BUTTON_LEFT,
                                               frame == 4 ? GLFW_PRESS : GLFW_RELEASE, 0);
        if (frame == 12)
            ImGui_ImplGlfw_ScrollCallback(window(), 0, 2);
    };
    view(session, {700, 400}, {18, {}, before_frame});
    EXPECT_EQ(poses[2], poses[4]);
    EXPECT_NE(poses[4], poses[10]);
    EXPECT_EQ(poses[10], poses[12]);
    EXPECT_NEAR(glm::distance(poses[4][3], poses[10][3]), 0, 2); // turned, about what it looks at
    EXPECT_NE(poses[12][3], poses[17][3]);
    EXPECT_EQ(poses[12][2], poses[17][2]); // nearer, in the same direction
}

TEST_F(ViewWindow, ADraggedSliderIsMeasuredWhenItIsLetGo) {
    const SquareScene files(SquareScene::Worn::measured);
    Session session({files.scene()});
    const auto document = [&] { return session.documents().at(files.cloth()); };
    uint64_t request = document().request;
    WindowHand hand;
    for (const char* sett : {"ends", "picks"}) {
        hand.point({"cloth", {sett}}, {0.1f, 0.5f});
        hand.press();
        hand.move({10, 0});
        hand.move({5, 0});
        hand.then([&] { EXPECT_EQ(document().request, request); }); // not before it is let go
        hand.release();
        hand.wait_until([&] { return document().request > request; });
        hand.then([&] { request = document().request; });
    }
    hand.use(session);
    tick_until(session, [&] { return !document().waiting; });
    EXPECT_EQ(document().error, "");
    EXPECT_GT(document().table->cloth->ends_per_cm, 25);
    EXPECT_GT(document().table->cloth->picks_per_cm, 25);
}

TEST_F(ViewWindow, AColourCanBeChosenWhereThereIsNone) {
    const SquareScene files(SquareScene::Worn::measured);
    std::string text = tests::coarse_cloth("0.3");
    text.erase(text.find("color = [0.3, 0.3, 0.3]\n[weft]"), 24);
    text.replace(text.rfind("color = [0.3, 0.3, 0.3]"), 23, "absorption_per_um = 0.001");
    tests::write_bytes(files.cloth(), text);
    Session session({files.scene()});
    const auto document = [&] { return session.documents().at(files.cloth()); };
    WindowHand hand;
    for (const char* yarn : {"Warp", "Weft"}) {
        hand.point({"cloth", {yarn, yarn, "colour", "##X"}});
        hand.press();
        for (int way = 0; way < 4; ++way)
            hand.move({-30, 0});
        hand.release();
        hand.wait_until([&] { return document().edited; });
    }
    hand.use(session);
    EXPECT_EQ(document().error, "");
    for (const YarnSpec* yarn : {&document().cloth->warp, &document().cloth->weft}) {
        ASSERT_TRUE(yarn->fibre.color);
        EXPECT_LT(yarn->fibre.color->at(0), 0.9);
        EXPECT_EQ(yarn->fibre.color->at(1), 0.999);
        EXPECT_FALSE(yarn->fibre.absorption_per_um);
    }
}

TEST_F(ViewWindow, KeysAndClicksDoWhatTheyAreFor) {
    const SquareScene files(SquareScene::Worn::measured);
    std::filesystem::current_path(files.scene().parent_path());
    Session session({files.scene()});
    const auto cloth = [&] { return session.documents().at(files.cloth()).cloth; };
    const std::shared_ptr<const Cloth> before = cloth();
    std::vector<glm::mat4> poses;
    const auto note_pose = [&] { poses.push_back(session.camera().to_world); };
    WindowHand hand;
    hand.point({"picture", {"picture"}}, {0.55f, 0.45f});
    hand.then([] { ImGui::GetIO().MouseDoubleClickTime = 10; }); // frames may be slow
    hand.click();
    hand.then(note_pose); // one click alone is nothing
    hand.click();
    hand.then(note_pose);
    hand.key('F');
    hand.then(note_pose);
    hand.wait_until([&] { return session.picture() != nullptr; });
    hand.key('S');
    hand.wait_until([&] { return !session.notes().empty(); });
    hand.point({"cloth", {"drawdown"}}, {0.25f, 0.25f}); // end 1, pick 2
    hand.click();
    hand.wait_until([&] { return cloth() != before; });
    hand.use(session);
    ASSERT_EQ(poses.size(), 3u);
    EXPECT_EQ(poses[0], load_scene({files.scene()}).scene->camera.to_world);
    EXPECT_NE(poses[1][3], poses[0][3]);
    EXPECT_EQ(poses[1][2], poses[0][2]); // moved sideways
    EXPECT_NE(poses[2][3], poses[1][3]);
    EXPECT_TRUE(std::filesystem::exists("scene-view.png"));
    EXPECT_TRUE(std::filesystem::exists("scene-view.exr"));
    for (int pick = 0; pick < 2; ++pick)
        for (int end = 0; end < 2; ++end)
            EXPECT_EQ(cloth()->draft.up(end, pick) != before->draft.up(end, pick),
                      end == 0 && pick == 1);
}

TEST_F(ViewWindow, AnErrorMovesNoControls) {
    const SquareScene files(SquareScene::Worn::measured);
    Session session({files.scene()});
    const auto document = [&] { return session.documents().at(files.cloth()); };
    EXPECT_GT(document().table->seconds, 0);
    std::vector<glm::vec2> places;
    WindowHand hand;
    const auto note_places = [&] {
        for (const WindowHand::Place& place :
             {WindowHand::Place{"cloth", {"picks"}}, {"scene", {"save picture (S)"}}}) {
            hand.point(place);
            hand.then([&] { places.push_back(hand.mouse()); });
        }
    };
    hand.wait_until([&] { return session.picture() && session.picture()->samples > 1; });
    note_places();
    hand.point({"cloth", {"ends"}}, {0.9f, 0.5f});
    hand.click();
    hand.wait_until([&] { return !document().error.empty(); });
    note_places();
    hand.use(session);
    ASSERT_EQ(places.size(), 4u);
    EXPECT_EQ(places[0], places[2]);
    EXPECT_EQ(places[1], places[3]);
}

TEST_F(ViewWindow, ThePanelGoesOnWithTheFileThatItSaved) {
    const SquareScene files(SquareScene::Worn::measured);
    Session session({files.scene()});
    const std::filesystem::path saved =
        std::filesystem::weakly_canonical(files / "cloth-edited.toml");
    tests::write_bytes(saved, "another's");
    WindowHand hand;
    hand.point({"cloth", {"ends"}}, {0.1f, 0.5f});
    hand.click();
    hand.wait_until([&] { return session.documents().at(files.cloth()).edited; });
    hand.point({"cloth", {"###save"}});
    hand.click();
    hand.then([&] { // there is such a file: to be told again
        EXPECT_EQ(session.choices().at("Body").file, files.cloth());
        EXPECT_EQ(tests::read_bytes(saved), "another's");
    });
    hand.click();
    hand.wait_until([&] { return session.choices().at("Body").file == saved; });
    hand.point({"cloth", {"picks"}}, {0.1f, 0.5f});
    hand.click();
    hand.wait_until([&] { return session.documents().at(saved).edited; });
    hand.use(session);
    EXPECT_LT(read_cloth(saved).ends_per_cm, 19);
    EXPECT_EQ(read_cloth(saved).picks_per_cm, 20);
    EXPECT_LT(session.documents().at(saved).cloth->picks_per_cm, 19);
}

/// Clicks a line of the combo that has just been clicked.
void pick(WindowHand& hand, const WindowHand::Place& combo, const std::string& line) {
    hand.point(combo);
    hand.click();
    hand.point({"##Combo_00", {line}}, {0.1f, 0.5f});
    hand.click();
}

TEST_F(ViewWindow, AMaterialTakesAnotherClothAndThatOfTheSceneAgain) {
    const SquareScene files(SquareScene::Worn::measured);
    const std::filesystem::path other = std::filesystem::weakly_canonical(files / "other.toml");
    tests::write_bytes(other, tests::coarse_cloth("0.6"));
    Session session({files.scene()});
    const ClothChoice own = session.choices().at("Body");
    const WindowHand::Place combo{"scene", {"Body", "cloth"}};
    WindowHand hand;
    pick(hand, combo, "other.toml##" + other.string());
    hand.wait_until([&] { return session.choices().at("Body").file == other; });
    hand.point({"scene", {"Body", "rotation"}}, {0.9f, 0.5f});
    hand.click();
    hand.wait_until([&] { return session.choices().at("Body").rotation > 45; });
    pick(hand, combo, "as in the scene");
    hand.wait_until([&] { return session.choices().at("Body") == own; });
    hand.use(session);
}

/// The pure colour that is nearest to what the window shows there. Mesa keeps the buffer that it
/// has shown.
glm::ivec3 pixel(const glm::vec2& place) {
    glm::ivec2 size;
    glfwGetFramebufferSize(glfwGetCurrentContext(), &size.x, &size.y);
    std::array<uint8_t, 4> colour{};
    glReadPixels(static_cast<int>(place.x), size.y - 1 - static_cast<int>(place.y), 1, 1, GL_RGBA,
                 GL_UNSIGNED_BYTE, colour.data());
    const auto pure = [](uint8_t channel) { return channel > 127 ? 255 : 0; };
    return {pure(colour[0]), pure(colour[1]), pure(colour[2])};
}

constexpr glm::ivec3 kRed{255, 0, 0}, kGreen{0, 255, 0}, kBlue{0, 0, 255}, kYellow{255, 255, 0},
    kWhite{255, 255, 255};

/// A table that glows in the colour of `of`.
BsdfTable glowing(const std::function<glm::ivec3(const IncidentDirection&, bool to_face)>& of) {
    return tests::synthetic_table([=](const auto& from, const glm::dvec3& out, size_t band) {
        return 0.05 / 255 * of(from, out.z > 0)[static_cast<int>(band)];
    });
}

/// The colours of the disc's middle, as they are when the hand gets there.
class DiscColours {
  public:
    const WindowHand::Place place{"cloth", {"map"}};
    std::vector<glm::ivec3> seen;

    explicit DiscColours(WindowHand& hand) : hand_(hand) {
        hand_.point(place);
        hand_.then([this] { middle_ = hand_.mouse(); });
        note();
    }
    void note() {
        hand_.then([] {});
        hand_.then([this] { seen.push_back(pixel(middle_)); });
    }

  private:
    WindowHand& hand_;
    glm::vec2 middle_{0};
};

TEST_F(ViewWindow, TheDiscIsOfTheSidesThatAreChosenAndOfTheLightThatIsDragged) {
    const SquareScene files(SquareScene::Worn::stored);
    write_table(glowing([](const IncidentDirection& from, bool to_face) {
                    if (std::sin(from.theta) * std::cos(from.phi) > 0.3)
                        return kWhite;
                    if (from.side == Side::front)
                        return to_face ? kRed : kGreen;
                    return to_face ? kYellow : kBlue;
                }),
                files.table());
    Session session({files.scene()});
    WindowHand hand;
    DiscColours disc(hand);
    const auto click = [&](const char* what, const char* side) {
        hand.point({"cloth", {what, side}});
        hand.click();
        disc.note();
    };
    click("seen", "back");
    click("lit", "back");
    click("seen", "face");
    hand.point(disc.place, {0.3f, 0.5f});
    hand.press();
    hand.move({60, 0});
    hand.move({20, 0});
    hand.release();
    disc.note();
    hand.use(session);
    EXPECT_EQ(disc.seen, (std::vector{kRed, kGreen, kBlue, kYellow, kWhite}));
}

TEST_F(ViewWindow, TheDiscIsOfTheColourwayThatIsChosenOrWorn) {
    const SquareScene files(SquareScene::Worn::stored);
    BsdfTable table = glowing([](const auto&, bool) { return kRed; });
    table.colourways["blue"] = glowing([](const auto&, bool) { return kBlue; });
    table.colourways["green"] = glowing([](const auto&, bool) { return kGreen; });
    write_table(table, files.table());
    Session session({files.scene()});
    WindowHand hand;
    DiscColours disc(hand);
    pick(hand, {"cloth", {"colourway"}}, "blue");
    disc.note();
    hand.then([&] { EXPECT_EQ(session.choices().at("Body").colourway, ""); }); // looked at only
    pick(hand, {"scene", {"Body", "colourway"}}, "green");
    hand.wait_until([&] { return session.choices().at("Body").colourway == "green"; });
    disc.note();
    hand.use(session);
    EXPECT_EQ(disc.seen, (std::vector{kRed, kBlue, kGreen}));
}

TEST_F(ViewWindow, TextFollowsTheScale) {
    Window window("scale", {320, 240});
    const auto text_height = [&] {
        window.begin_frame(0);
        const float height = ImGui::GetFontSize();
        ImGui::TextUnformatted("scale");
        window.end_frame();
        return height;
    };
    const float once = text_height(), spacing = ImGui::GetStyle().ItemSpacing.x;
    window.set_text_scale(2);
    EXPECT_EQ(text_height(), 2 * once);
    EXPECT_EQ(ImGui::GetStyle().ItemSpacing.x, 2 * spacing);
    window.set_text_scale(1, 2); // as large, of finer pixels
    EXPECT_EQ(text_height(), once);
    EXPECT_EQ(ImGui::GetFont()->FontSize, 2 * once);
    window.set_text_scale(1);
    EXPECT_EQ(text_height(), once);
    EXPECT_EQ(ImGui::GetFont()->FontSize, once);
    EXPECT_FALSE(window.lost());
}

} // namespace
} // namespace rapport
