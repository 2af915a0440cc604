#include "renderer/preview/view.h"

#include "renderer/preview/cloth_panel.h"
#include "renderer/preview/scene_panel.h"
#include "renderer/preview/window.h"

#include <imgui.h>

namespace rapport {
namespace {

constexpr float kPanelWidth = 21.5f; ///< of each side, in heights of a line of text

constexpr ImGuiWindowFlags kFixed = ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoMove |
                                    ImGuiWindowFlags_NoSavedSettings |
                                    ImGuiWindowFlags_NoBringToFrontOnFocus;

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
        texture_.set(displayed(picture->image, session.tone), picture->image.width,
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

} // namespace

void view(Session& session, const glm::ivec2& size, const ViewRun& run) {
    Window window("rapport " + session.source().path.filename().string(), size);
    PictureArea area;
    ClothPanel cloth_panel;
    std::filesystem::path selected = first_cloth(session);
    for (int frame = 0; window.open() && (run.frames == 0 || frame < run.frames); ++frame) {
        window.begin_frame(area.coarse() || ImGui::IsAnyMouseDown() ? 1.0 / 60 : 1.0 / 15);
        const float width = ImGui::GetIO().DisplaySize.x;
        const float side = std::min(kPanelWidth * ImGui::GetFontSize(), 0.3f * width);
        part("scene", 0, side, [&] { draw_scene_panel(session, selected); });
        ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, {0, 0});
        part("picture", side, width - 2 * side, [&] {
            if (!window.minimised())
                area.draw(session, window.pixel_ratio());
        });
        ImGui::PopStyleVar();
        part("cloth", width - side, side, [&] { cloth_panel.draw(session, selected); });
        if (!ImGui::GetIO().WantTextInput) {
            if (ImGui::IsKeyPressed('F', false))
                session.frame_all();
            if (ImGui::IsKeyPressed('S', false))
                session.save_shown();
        }
        session.tick();
        window.end_frame(frame + 1 == run.frames ? run.screenshot : std::filesystem::path());
    }
}

} // namespace rapport
