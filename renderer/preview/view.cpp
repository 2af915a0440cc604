#include "renderer/preview/view.h"

#include "renderer/core/error.h"
#include "renderer/preview/cloth_panel.h"
#include "renderer/preview/scene_panel.h"
#include "renderer/preview/window.h"

#include <fmt/format.h>
#include <imgui.h>

namespace rapport {
namespace {

constexpr float kPanelWidth = 21.5f; ///< of each side, in heights of a line of text

constexpr ImGuiWindowFlags kFixed = ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoMove |
                                    ImGuiWindowFlags_NoSavedSettings |
                                    ImGuiWindowFlags_NoBringToFrontOnFocus;

float panel_width(float window_width, float font_size) {
    return std::min(kPanelWidth * font_size, 0.3f * window_width);
}

/// The picture on the screen: as large as its part of the window, renewed when there is another.
class PictureArea {
  public:
    void draw(Session& session, float pixel_ratio) {
        const ImVec2 corner = ImGui::GetCursorScreenPos(), size = ImGui::GetContentRegionAvail();
        if (size.x < 1 || size.y < 1)
            return;
        session.resize({size.x * pixel_ratio, size.y * pixel_ratio});
        ImGui::InvisibleButton("picture", size,
                               ImGuiButtonFlags_MouseButtonLeft |
                                   ImGuiButtonFlags_MouseButtonRight |
                                   ImGuiButtonFlags_MouseButtonMiddle);
        take_input(session, corner, pixel_ratio);
        renew(session);
        if (!texture_.empty())
            ImGui::GetWindowDrawList()->AddImage(texture_.id(), corner,
                                                 {corner.x + size.x, corner.y + size.y});
    }
    /// Whether more of this view is still to be seen soon.
    bool coarse() const { return !shown_ || shown_->scale > 1; }

  private:
    static void take_input(Session& session, const ImVec2& corner, float ratio) {
        const ImGuiIO& io = ImGui::GetIO();
        const glm::vec2 way = ratio * glm::vec2(io.MouseDelta.x, io.MouseDelta.y);
        if (ImGui::IsItemActive() && way != glm::vec2(0)) {
            if (ImGui::IsMouseDown(ImGuiMouseButton_Left) && !io.KeyShift)
                session.orbit(way);
            else
                session.pan(way);
        }
        if (!ImGui::IsItemHovered())
            return;
        if (io.MouseWheel != 0)
            session.zoom(io.MouseWheel);
        if (ImGui::IsMouseDoubleClicked(ImGuiMouseButton_Left))
            session.focus(ratio * glm::vec2(io.MousePos.x - corner.x, io.MousePos.y - corner.y));
    }

    void renew(const Session& session) {
        const std::shared_ptr<const TracedPicture> picture = session.picture();
        if (!picture || (picture == shown_ && session.tone == tone_))
            return;
        texture_.set(displayed(picture->image, picture->camera, session.tone), picture->image.width,
                     picture->image.height);
        shown_ = picture;
        tone_ = session.tone;
    }

    Texture texture_;
    std::shared_ptr<const TracedPicture> shown_;
    Tone tone_;
};

/// A part of the window, from `left` on.
template <class Draw> void part(const char* name, float left, float width, const Draw& draw) {
    ImGui::SetNextWindowPos({left, 0});
    ImGui::SetNextWindowSize({width, ImGui::GetIO().DisplaySize.y});
    if (ImGui::Begin(name, nullptr, kFixed & ~ImGuiWindowFlags_NoScrollbar))
        draw();
    ImGui::End();
}

std::filesystem::path first_cloth(const Session& session) {
    for (const auto& [name, choice] : session.choices())
        return choice.file;
    return {};
}

/// Whether the key of a capital letter has just been pressed. From 1.87 on Dear ImGui has names of
/// its own for all keys.
bool went_down(char letter) {
#if IMGUI_VERSION_NUM >= 18700
    return ImGui::IsKeyPressed(static_cast<ImGuiKey>(ImGuiKey_A + (letter - 'A')), false);
#else
    return ImGui::IsKeyPressed(letter, false);
#endif
}

/// The window and what is drawn in it.
class View {
  public:
    View(Session& session, const glm::ivec2& size)
        : session_(session), window_("rapport " + session.source().path.filename().string(), size),
          selected_(first_cloth(session)) {}

    /// Frames from number `frame` on; true if it ends because its pictures are lost.
    bool run(const ViewRun& run, int& frame) {
        for (; window_.open() && (run.frames == 0 || frame < run.frames); ++frame) {
            if (run.before_frame)
                run.before_frame(frame);
            if (window_.lost())
                return true;
            window_.begin_frame(area_.coarse() || ImGui::IsAnyMouseDown() ? 1.0 / 60 : 1.0 / 15);
            if (!window_.minimised())
                draw();
            take_keys();
            session_.tick();
            window_.end_frame(frame + 1 == run.frames ? run.screenshot : std::filesystem::path());
        }
        return false;
    }
    glm::ivec2 size() const { return window_.size(); }

  private:
    void draw() {
        const float width = ImGui::GetIO().DisplaySize.x, ratio = window_.pixel_ratio();
        const float side = panel_width(width, ImGui::GetFontSize());
        part("scene", 0, side, [&] { draw_scene_panel(session_, selected_); });
        ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, {0, 0});
        part("picture", side, width - 2 * side, [&] { area_.draw(session_, ratio); });
        ImGui::PopStyleVar();
        part("cloth", width - side, side, [&] { cloth_panel_.draw(session_, selected_, ratio); });
    }

    void take_keys() {
        if (ImGui::GetIO().WantTextInput)
            return;
        if (went_down('F'))
            session_.frame_all();
        if (went_down('S'))
            session_.save_shown();
    }

    Session& session_;
    Window window_; ///< before all that draws in it
    PictureArea area_;
    ClothPanel cloth_panel_;
    std::filesystem::path selected_;
};

} // namespace

std::vector<std::string> view(Session& session, const glm::ivec2& size, const ViewRun& run) {
    constexpr int kMostLosses = 3; // more are a driver that will not work
    // The picture is traced while the window opens; on a finer screen it is larger, of one shape.
    const auto width = static_cast<float>(size.x);
    session.resize({width - 2 * panel_width(width, Window::kFontSize), size.y});
    session.tick();
    glm::ivec2 opened = size;
    int frame = 0;
    for (int losses = 0;; ++losses) {
        View view(session, opened);
        if (!view.run(run, frame)) {
            const auto shown = static_cast<std::ptrdiff_t>(session.notes().size());
            if (session.edited())
                session.rescue("closed with edits that had not been saved");
            return {session.notes().begin() + shown, session.notes().end()};
        }
        session.rescue("the graphics driver was reset: the window is a new one");
        if (losses == kMostLosses)
            throw FileError("window", "", "a graphics driver that keeps its pictures",
                            fmt::format("{} resets", losses + 1));
        opened = view.size();
    }
}

} // namespace rapport
