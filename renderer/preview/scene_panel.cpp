#include "renderer/preview/scene_panel.h"

#include "renderer/preview/cloth_controls.h"

#include <algorithm>
#include <fmt/format.h>
#include <imgui.h>

namespace rapport {
namespace {

const ImVec4 kRed{1.0f, 0.45f, 0.4f, 1};
const ImVec4 kGrey{0.6f, 0.6f, 0.62f, 1};

void text(const std::string& line) { ImGui::TextUnformatted(line.c_str()); }

void wrapped(const ImVec4& colour, const std::string& line) {
    ImGui::PushStyleColor(ImGuiCol_Text, colour);
    ImGui::TextWrapped("%s", line.c_str());
    ImGui::PopStyleColor();
}

/// A choice among files, shown by their names; none is what the scene has.
bool pick_file(const char* label, std::filesystem::path& file,
               const std::vector<std::filesystem::path>& files) {
    bool picked = false;
    constexpr const char* kNone = "as in the scene";
    if (!ImGui::BeginCombo(label, file.empty() ? kNone : file.filename().c_str()))
        return false;
    const auto offer = [&](const std::string& line, const std::filesystem::path& other) {
        if (ImGui::Selectable(line.c_str(), other == file)) {
            picked = other != file;
            file = other;
        }
    };
    offer(kNone, {});
    for (const std::filesystem::path& other : files) // of which two may have one name
        offer(other.filename().string() + "##" + other.string(), other);
    ImGui::EndCombo();
    return picked;
}

const ClothDocument* document_of(const Session& session, const std::filesystem::path& file) {
    const auto found = session.documents().find(file);
    return found == session.documents().end() ? nullptr : &found->second;
}

std::string table_line(const ClothDocument& document) {
    if (!document.table)
        return document.waiting ? "being measured …" : "";
    return fmt::format("ε {:.3f}{}", document.table->accuracy,
                       document.waiting ? ", measuring anew …" : "");
}

void draw_garment(Session& session, std::filesystem::path& selected) {
    for (const std::string& name : session.wearers()) {
        ImGui::PushID(name.c_str());
        const auto worn = session.choices().find(name);
        ClothChoice choice = worn == session.choices().end() ? ClothChoice{} : worn->second;
        text(name);
        bool changed = pick_file("cloth", choice.file, session.shelf());
        if (changed)
            choice.colourway.clear();
        if (!choice.file.empty()) {
            const ClothDocument* document = document_of(session, choice.file);
            if (document && document->table)
                changed |= pick_colourway(*document->table, choice.colourway);
            changed |= ImGui::SliderFloat("rotation", &choice.rotation, -90, 90, "%.0f°");
            if (document) // a line whether told or not, and one only: the controls below stay
                ImGui::TextColored(kGrey, "%s", table_line(*document).c_str());
            if (document && document->cloth && choice.file != selected &&
                ImGui::SmallButton("edit this cloth"))
                selected = choice.file;
        }
        if (changed) {
            session.choose_cloth(name, choice);
            const auto now = session.choices().find(name);
            selected = now == session.choices().end() ? "" : now->second.file;
        }
        ImGui::Spacing();
        ImGui::PopID();
    }
}

void draw_lights(Session& session) {
    const LightKinds kinds = session.light_kinds();
    LightSettings lights = session.lights();
    if (kinds.sky) {
        ImGui::SliderFloat("sky", &lights.sky, 0, 4, "× %.2f", ImGuiSliderFlags_Logarithmic);
        ImGui::SliderFloat("sky turned", &lights.sky_rotation, -180, 180, "%.0f°");
    }
    if (kinds.sun) {
        ImGui::SliderFloat("sun", &lights.sun, 0, 4, "× %.2f", ImGuiSliderFlags_Logarithmic);
        ImGui::SliderFloat("sun turned", &lights.sun_rotation, -180, 180, "%.0f°");
    }
    if (kinds.lamps)
        ImGui::SliderFloat("lamps", &lights.lamps, 0, 4, "× %.2f", ImGuiSliderFlags_Logarithmic);
    session.set_lights(lights);
}

template <class Enum, size_t N>
void pick(const char* label, Enum& value, const char* const (&names)[N]) {
    int index = static_cast<int>(value);
    if (ImGui::Combo(label, &index, names, N))
        value = static_cast<Enum>(index);
}

void draw_display(Tone& tone) {
    ImGui::SliderFloat("exposure", &tone.exposure, -5, 5, "%+.1f stops");
    pick("tone", tone.curve, kToneCurveNames);
    pick("show", tone.layer, kLayerNames);
}

/// Below all controls, for its lines come and go.
void draw_progress(const Session& session) {
    if (const std::shared_ptr<const TracedPicture> picture = session.picture()) {
        text(fmt::format("{} × {}, {} sample{}", picture->image.width, picture->image.height,
                         picture->samples, picture->samples == 1 ? "" : "s"));
        if (picture->samples > 1)
            text(fmt::format("noise {:.3f}", picture->noise));
        text(fmt::format("{:.2f} Mrays/s", picture->rays_per_second * 1e-6));
    }
    if (const std::filesystem::path file = session.worker().working_on(); !file.empty())
        text("measuring " + file.filename().string());
}

/// Last in the panel, for they come and go.
void draw_messages(const Session& session, const std::filesystem::path& selected) {
    if (const std::string error = session.error(); !error.empty())
        wrapped(kRed, error);
    for (const auto& [file, document] : session.documents())
        if (!document.error.empty() && (file == selected || session.worn(file)))
            wrapped(kRed, document.error);
    for (size_t i = session.notes().size(); i > 0 && i + 3 > session.notes().size(); --i)
        wrapped(kGrey, session.notes()[i - 1]);
}

void draw_files(Session& session) {
    if (ImGui::Button("save picture (S)"))
        session.save_shown();
    ImGui::SameLine();
    const bool scene_file = session.source().path.extension() == ".pbrt";
    ImGui::BeginDisabled(!scene_file);
    if (ImGui::Button("save camera"))
        session.save_camera();
    ImGui::EndDisabled();
    if (!scene_file && ImGui::IsItemHovered(ImGuiHoveredFlags_AllowWhenDisabled))
        ImGui::SetTooltip("a bare model has no scene file to copy");
}

bool section(const char* title) {
    return ImGui::CollapsingHeader(title, ImGuiTreeNodeFlags_DefaultOpen);
}

} // namespace

void draw_scene_panel(Session& session, std::filesystem::path& selected) {
    ImGui::PushItemWidth(0.62f * ImGui::GetContentRegionAvail().x);
    if (section("Garment"))
        draw_garment(session, selected);
    if (section("Light"))
        draw_lights(session);
    if (section("Display"))
        draw_display(session.tone);
    if (section("Picture")) {
        wrapped(kGrey,
                "drag: turn   right drag: move   wheel: nearer\ndouble click: look at   F: all");
        draw_files(session);
        draw_progress(session);
    }
    draw_messages(session, selected);
    ImGui::PopItemWidth();
}

} // namespace rapport
