#include "renderer/preview/cloth_panel.h"

#include "renderer/preview/cloth_controls.h"
#include "renderer/preview/hemisphere.h"

#include <algorithm>
#include <cstring>
#include <fmt/format.h>
#include <imgui.h>

namespace rapport {
namespace {

constexpr int kMapSize = 128, kCurvePoints = 181;
const ImVec4 kRed{1.0f, 0.45f, 0.4f, 1};

void draw_curve(const char* label, const std::vector<float>& curve) {
    ImGui::PushID(label);
    const float top = 1.35f * *std::ranges::max_element(curve); // the label stands above
    ImGui::PlotLines("", curve.data(), static_cast<int>(curve.size()), 0, label, 0, top,
                     {0, 4.6f * ImGui::GetFontSize()});
    ImGui::PopID();
}

void pick_side(const char* label, Side& side) {
    ImGui::PushID(label);
    ImGui::AlignTextToFramePadding();
    ImGui::TextUnformatted(label);
    for (const Side other : {Side::front, Side::back}) {
        ImGui::SameLine((other == Side::front ? 4.0f : 8.0f) * ImGui::GetFontSize());
        if (ImGui::RadioButton(other == Side::front ? "face" : "back", side == other))
            side = other;
    }
    ImGui::PopID();
}

} // namespace

/// Another that is worn takes the place of what was looked at.
void ClothPanel::follow_worn_colourway(const Session& session) {
    std::string worn;
    for (const auto& [name, choice] : session.choices())
        if (choice.file == file_) {
            worn = choice.colourway;
            break;
        }
    if (worn != worn_colourway_)
        colourway_ = worn_colourway_ = worn;
}

/// Under the light that draw_light() has dragged about.
void ClothPanel::draw_fibres(const ClothTable& table, float pixel_ratio) {
    if (table.swatches.empty()) {
        ImGui::TextDisabled("a stored table has no fibres");
        return;
    }
    const float width = ImGui::GetContentRegionAvail().x;
    const ImVec2 corner = ImGui::GetCursorScreenPos(), size(width, std::floor(0.45f * width));
    // A window of its own, lest the wheel scroll the panel.
    ImGui::BeginChild("fibres", size, false,
                      ImGuiWindowFlags_NoScrollbar | ImGuiWindowFlags_NoScrollWithMouse);
    ImGui::InvisibleButton("picture", size);
    fibres_.show(table.swatches.at(colourway_), disc_direction(lobe_.light, lobe_.lit),
                 glm::max(glm::ivec2(size.x * pixel_ratio, size.y * pixel_ratio), 1));
    const ImGuiIO& io = ImGui::GetIO();
    if (const glm::vec2 way(io.MouseDelta.x, io.MouseDelta.y);
        ImGui::IsItemActive() && way != glm::vec2(0))
        fibres_.orbit(pixel_ratio * way);
    if (ImGui::IsItemHovered() && io.MouseWheel != 0)
        fibres_.zoom(io.MouseWheel);
    if (const auto picture = fibres_.picture(); picture && picture != shown_fibres_) {
        if (!fibre_picture_)
            fibre_picture_ = std::make_unique<Texture>();
        fibre_picture_->set(displayed(picture->image, picture->camera, {}), picture->image.width,
                            picture->image.height);
        shown_fibres_ = picture;
    }
    if (fibre_picture_)
        ImGui::GetWindowDrawList()->AddImage(fibre_picture_->id(), corner,
                                             {corner.x + size.x, corner.y + size.y});
    ImGui::EndChild();
}

void ClothPanel::draw_light() {
    if (lobe_ != mapped_) {
        const TableBsdf& table = *lobe_.table;
        const glm::vec3 from = disc_direction(lobe_.light, lobe_.lit);
        if (!map_)
            map_ = std::make_unique<Texture>();
        map_->set(hemisphere_map(table, from, lobe_.seen, kMapSize), kMapSize, kMapSize);
        weft_curve_ = intensity_profile(table, from, lobe_.seen, false, kCurvePoints);
        warp_curve_ = intensity_profile(table, from, lobe_.seen, true, kCurvePoints);
        mapped_ = lobe_;
    }
    const float side = 10 * ImGui::GetFontSize();
    const ImVec2 corner = ImGui::GetCursorScreenPos();
    ImGui::InvisibleButton("map", {side, side});
    if (ImGui::IsItemActive()) {
        const ImVec2 mouse = ImGui::GetIO().MousePos;
        lobe_.light = {2 * (mouse.x - corner.x) / side - 1, 1 - 2 * (mouse.y - corner.y) / side};
        lobe_.light /= std::max(1.0f, glm::length(lobe_.light));
    }
    ImDrawList& list = *ImGui::GetWindowDrawList();
    list.AddImage(map_->id(), corner, {corner.x + side, corner.y + side});
    const ImVec2 lamp(corner.x + 0.5f * side * (1 + lobe_.light.x),
                      corner.y + 0.5f * side * (1 - lobe_.light.y));
    const int strength = lobe_.lit == lobe_.seen ? 255 : 110; // or it stands behind the cloth
    list.AddCircle(lamp, 0.35f * ImGui::GetFontSize(), IM_COL32(255, 220, 90, strength), 0, 2);
    ImGui::SameLine();
    ImGui::BeginGroup();
    ImGui::PushItemWidth(ImGui::GetContentRegionAvail().x);
    draw_curve("along the weft", weft_curve_);
    draw_curve("along the warp", warp_curve_);
    ImGui::PopItemWidth();
    ImGui::EndGroup();
    pick_side("lit", lobe_.lit);
    ImGui::SameLine();
    ImGui::TextDisabled("drag the ring");
    pick_side("seen", lobe_.seen);
}

void ClothPanel::draw_save(Session& session, std::filesystem::path& file) {
    ImGui::InputText("##target", target_, sizeof target_);
    ImGui::SameLine();
    const std::filesystem::path target = file.parent_path() / target_;
    const bool again = target == refused_;
    if (!ImGui::Button(again ? "overwrite###save" : "save###save"))
        return;
    const std::filesystem::path next = session.save_cloth(file, target, again);
    const bool refused = next == file && target != file && std::filesystem::exists(target);
    refused_ = refused ? target : "";
    file = file_ = next;
}

void ClothPanel::draw(Session& session, std::filesystem::path& file, float pixel_ratio) {
    const auto found = session.documents().find(file);
    if (found == session.documents().end()) {
        ImGui::TextWrapped("No cloth is worn: choose one at the left.");
        return;
    }
    const ClothDocument& document = found->second;
    if (file_ != file) {
        file_ = file;
        colourway_ = worn_colourway_ = "";
        const std::string name = file.stem().string() + "-edited.toml";
        std::strncpy(target_, name.c_str(), sizeof target_ - 1);
    }
    if (document.cloth && document.cloth != shown_) {
        shown_ = document.cloth;
        cloth_ = *shown_;
    }
    ImGui::PushItemWidth(0.62f * ImGui::GetContentRegionAvail().x);
    ImGui::TextWrapped("%s%s", file.filename().string().c_str(),
                       document.edited ? " (edited)" : "");
    if (!document.error.empty()) // one line, lest it push the controls from under the mouse
        ImGui::TextColored(kRed, "not measured: why, at the left");
    else if (document.waiting)
        ImGui::TextUnformatted("being measured …");
    else if (document.table)
        ImGui::TextUnformatted(fmt::format("ε {:.3f} after {:.1f} s", document.table->accuracy,
                                           document.table->seconds)
                                   .c_str());
    // The document ends when it is saved as another file.
    const std::shared_ptr<const ClothTable> table = document.table;
    if (document.cloth &&
        ImGui::CollapsingHeader("Weave and yarns", ImGuiTreeNodeFlags_DefaultOpen)) {
        if (draw_cloth_controls(cloth_))
            session.edit_cloth(file, cloth_);
        draw_save(session, file);
    }
    if (table) {
        follow_worn_colourway(session);
        if (!table->dyed.contains(colourway_))
            colourway_.clear();
        pick_colourway(*table, colourway_);
        lobe_.table = table->dyed.at(colourway_);
        if (ImGui::CollapsingHeader("Fibres", ImGuiTreeNodeFlags_DefaultOpen))
            draw_fibres(*table, pixel_ratio);
        if (ImGui::CollapsingHeader("Light", ImGuiTreeNodeFlags_DefaultOpen))
            draw_light();
    }
    ImGui::PopItemWidth();
}

} // namespace rapport
