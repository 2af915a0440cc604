#pragma once

#include "renderer/preview/view.h"

#define GLFW_INCLUDE_NONE // the test's own OpenGL loader comes in any order
#include <GLFW/glfw3.h>
#include <backends/imgui_impl_glfw.h>
#include <chrono>
#include <functional>
#include <gtest/gtest.h>
#include <imgui_internal.h>
#include <string>
#include <vector>

namespace rapport::tests {

inline int button_held = -1;

} // namespace rapport::tests

/// Takes the place of GLFW's, which Dear ImGui 1.86 asks whether a button is held.
extern "C" [[gnu::used]] inline int glfwGetMouseButton(GLFWwindow*, int button) {
    return button == rapport::tests::button_held ? GLFW_PRESS : GLFW_RELEASE;
}

namespace rapport::tests {

/// A hand at the window's mouse and keys: does one thing a frame, in order, through the functions
/// that GLFW calls, and closes the window.
class WindowHand {
  public:
    /// A control's place: the part of the window, and the labels of what it lies in and its own.
    struct Place {
        std::string part;
        std::vector<std::string> labels;
    };

    /// Moves the mouse to the point of a control that is so far from its upper left corner, of 1.
    void point(const Place& place, const glm::vec2& at = {0.5f, 0.5f}) {
        constexpr int kMostFrames = 20; // in which a list opens and ImGui notes where the line is
        steps_.push_back([=, this, frames = 0]() mutable {
            ImGuiWindow* const part = ImGui::FindWindowByName(place.part.c_str());
            const ImGuiContext& context = *ImGui::GetCurrentContext();
            if (part && context.NavId == id(place) && context.NavIdIsAlive) {
                const ImRect box =
                    ImGui::WindowRectRelToAbs(part, part->NavRectRel[ImGuiNavLayer_Main]);
                move_to({box.Min.x + at.x * box.GetWidth(), box.Min.y + at.y * box.GetHeight()});
                return true;
            }
            look_for(place);
            if (++frames < kMostFrames)
                return false;
            ADD_FAILURE() << "there is no " << place.labels.back();
            return true;
        });
        then([] {});
    }
    void move(const glm::vec2& way) {
        then([=, this] { move_to(mouse_ + way); });
    }
    void press() { button(GLFW_PRESS); }
    void release() { button(GLFW_RELEASE); }
    void click() {
        press();
        release();
    }
    void key(char letter) {
        for (const int action : {GLFW_PRESS, GLFW_RELEASE})
            then(
                [=] { ImGui_ImplGlfw_KeyCallback(glfwGetCurrentContext(), letter, 0, action, 0); });
    }
    void wait_until(std::function<bool()> done) { steps_.push_back(std::move(done)); }
    void then(const std::function<void()>& action) {
        steps_.push_back([=] {
            action();
            return true;
        });
    }

    const glm::vec2& mouse() const { return mouse_; }

    /// Opens a window of that size on the session and does all of it. Returns what `view` does.
    std::vector<std::string> use(Session& session, const glm::ivec2& size = {1200, 900}) {
        using Clock = std::chrono::steady_clock;
        const Clock::time_point latest =
            Clock::now() + std::chrono::minutes(5); // as tick_until does
        size_t next = 0;
        const auto before_frame = [&](int frame) {
            if (frame == 0)
                glfwFocusWindow(glfwGetCurrentContext());
            if (frame < 2)
                return; // what there is to point at has to be drawn first
            if (next == steps_.size() || Clock::now() > latest)
                glfwSetWindowShouldClose(glfwGetCurrentContext(), GLFW_TRUE);
            else if (steps_[next]())
                ++next;
        };
        const std::vector<std::string> notes = view(session, size, {0, {}, before_frame});
        EXPECT_EQ(next, steps_.size()) << "the window closed before the hand was done";
        return notes;
    }

  private:
    static ImGuiID id(const Place& place) {
        ImGuiID id = ImHashStr(place.part.c_str());
        for (const std::string& label : place.labels)
            id = ImHashStr(label.c_str(), 0, id);
        return id;
    }
    /// ImGui keeps the place of the item that is in focus.
    static void look_for(const Place& place) {
        ImGuiContext& context = *ImGui::GetCurrentContext();
        context.NavWindow = ImGui::FindWindowByName(place.part.c_str());
        context.NavId = id(place);
    }
    void move_to(const glm::vec2& mouse) {
        mouse_ = mouse;
        glfwSetCursorPos(glfwGetCurrentContext(), mouse.x, mouse.y);
    }
    void button(int action) {
        then([=] {
            button_held = action == GLFW_PRESS ? GLFW_MOUSE_BUTTON_LEFT : -1;
            ImGui_ImplGlfw_MouseButtonCallback(glfwGetCurrentContext(), GLFW_MOUSE_BUTTON_LEFT,
                                               action, 0);
        });
    }

    std::vector<std::function<bool()>> steps_;
    glm::vec2 mouse_{0};
};

} // namespace rapport::tests
