#include "renderer/preview/cloth_controls.h"

#include "renderer/core/srgb.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <imgui.h>

namespace rapport {
namespace {

constexpr int kWidestGrid = 32; ///< threads; more cannot be clicked
constexpr const char* kWeaves[] = {"plain",     "twill 2/1 Z", "twill 2/2 Z", "twill 3/1 Z",
                                   "satin 5/2", "satin 8/3",   "sateen 5/2",  "basket 2"};

const ImU32 kWarpColour = IM_COL32(214, 196, 160, 255), kWeftColour = IM_COL32(58, 66, 84, 255),
            kHoverColour = IM_COL32(255, 140, 60, 255);

/// Whether the control just drawn was let go with another value.
bool let_go() { return ImGui::IsItemDeactivatedAfterEdit(); }

bool slider(const char* label, double& value, double low, double high, const char* format,
            ImGuiSliderFlags flags = 0) {
    ImGui::SliderScalar(label, ImGuiDataType_Double, &value, &low, &high, format, flags);
    return let_go();
}

/// The drawdown, pick 1 at the bottom, warp in front light. A click turns a crossing over.
bool draw_drawdown(Draft& draft) {
    if (draft.ends > kWidestGrid || draft.picks > kWidestGrid) {
        ImGui::TextUnformatted(fmt::format("{} ends × {} picks", draft.ends, draft.picks).c_str());
        return false;
    }
    const float widest = 0.45f * ImGui::GetContentRegionAvail().x;
    const float cell = std::floor(
        std::clamp(widest / std::max(draft.ends, draft.picks), 6.0f, ImGui::GetFontSize() * 1.5f));
    const ImVec2 corner = ImGui::GetCursorScreenPos();
    ImGui::InvisibleButton("drawdown", {cell * draft.ends, cell * draft.picks});
    const ImVec2 mouse = ImGui::GetIO().MousePos;
    const int end = static_cast<int>((mouse.x - corner.x) / cell);
    const int pick = draft.picks - 1 - static_cast<int>((mouse.y - corner.y) / cell);
    const bool within =
        ImGui::IsItemHovered() && end >= 0 && end < draft.ends && pick >= 0 && pick < draft.picks;
    const bool clicked = within && ImGui::IsItemClicked();
    if (clicked)
        draft.set_up(end, pick, !draft.up(end, pick));
    ImDrawList& list = *ImGui::GetWindowDrawList();
    for (int p = 0; p < draft.picks; ++p)
        for (int e = 0; e < draft.ends; ++e) {
            const ImVec2 low(corner.x + cell * e, corner.y + cell * (draft.picks - 1 - p));
            const ImVec2 high(low.x + cell - 1, low.y + cell - 1);
            list.AddRectFilled(low, high, draft.up(e, p) ? kWarpColour : kWeftColour);
            if (within && e == end && p == pick)
                list.AddRect(low, high, kHoverColour);
        }
    return clicked;
}

/// Another number of ends and picks; new crossings are those of the repeat.
Draft resized(const Draft& draft, int ends, int picks) {
    Draft made;
    made.ends = ends;
    made.picks = picks;
    made.warp_up.resize(static_cast<size_t>(ends) * picks);
    for (int pick = 0; pick < picks; ++pick)
        for (int end = 0; end < ends; ++end)
            made.set_up(end, pick, draft.up(end % draft.ends, pick % draft.picks));
    return made;
}

bool draw_weave(Draft& draft) {
    bool changed = draw_drawdown(draft);
    if (!draft.warp_yarns.empty() || !draft.weft_yarns.empty())
        return changed; // its size is that of the order of yarns
    ImGui::SameLine();
    ImGui::BeginGroup();
    ImGui::PushItemWidth(0.6f * ImGui::GetContentRegionAvail().x);
    if (ImGui::BeginCombo("##weave", "weave")) {
        for (const char* name : kWeaves)
            if (ImGui::Selectable(name)) {
                draft = named_weave(name);
                changed = true;
            }
        ImGui::EndCombo();
    }
    int ends = draft.ends, picks = draft.picks;
    ImGui::InputInt("ends##repeat", &ends); // the sett's sliders bear the same names
    ImGui::InputInt("picks##repeat", &picks);
    ImGui::PopItemWidth();
    ImGui::EndGroup();
    ends = std::clamp(ends, 1, kWidestGrid);
    picks = std::clamp(picks, 1, kWidestGrid);
    const bool small = draft.ends <= kWidestGrid && draft.picks <= kWidestGrid;
    if (small && (ends != draft.ends || picks != draft.picks)) {
        draft = resized(draft, ends, picks);
        changed = true;
    }
    return changed;
}

float decode_srgb(float encoded) {
    return encoded <= 0.04045f ? encoded / 12.92f : std::pow((encoded + 0.055f) / 1.055f, 2.4f);
}

/// The dye as the colour it gives; white where none is told. The first that is chosen takes the
/// place of an absorption.
bool draw_colour(Dye& dye, const Bands& bands) {
    if (!bands.is_rgb()) {
        ImGui::TextDisabled("dyed by wavelength, in the file");
        return false;
    }
    constexpr double kBrightest = 0.999;
    float shown[3];
    for (int c = 0; c < 3; ++c)
        shown[c] = dye.color ? encode_srgb(static_cast<float>((*dye.color)[c])) : 1;
    if (ImGui::ColorEdit3("colour", shown)) {
        dye.absorption_per_um.reset();
        dye.color.emplace(3);
        for (int c = 0; c < 3; ++c)
            (*dye.color)[c] =
                std::clamp(static_cast<double>(decode_srgb(shown[c])), 0.0, kBrightest);
    }
    const bool chosen = let_go();
    if (dye.absorption_per_um)
        ImGui::TextDisabled("dyed by absorption, until a colour is chosen");
    return chosen;
}

bool draw_yarn(YarnSpec& yarn, const Bands& bands) {
    bool changed = false;
    if (yarn.section == YarnSection::parallel) {
        constexpr ImGuiSliderFlags kLogarithmic = ImGuiSliderFlags_Logarithmic;
        changed |= slider("width", yarn.width_um, 20, 1000, "%.0f µm", kLogarithmic);
        changed |= slider("height", yarn.height_um, 20, 1000, "%.0f µm", kLogarithmic);
    } else {
        changed |= slider("diameter", yarn.width_um, 20, 1000, "%.0f µm");
        yarn.height_um = yarn.width_um;
        changed |= slider("twist", yarn.twist_per_m, -3000, 3000, "%.0f /m");
    }
    ImGui::SliderInt("fibres", &yarn.fibres, 1, 200);
    changed |= let_go();
    changed |= slider("fibre", yarn.fibre.diameter_um, 1, 100, "%.1f µm");
    changed |= slider("roughness", yarn.fibre.roughness, 0, 0.5, "%.3f");
    return changed | draw_colour(yarn.fibre, bands);
}

} // namespace

bool draw_cloth_controls(Cloth& cloth) {
    bool changed = draw_weave(cloth.draft);
    changed |= slider("ends", cloth.ends_per_cm, 2, 150, "%.1f per cm");
    changed |= slider("picks", cloth.picks_per_cm, 2, 150, "%.1f per cm");
    const auto system = [&](const char* title, YarnSpec& yarn) {
        ImGui::PushID(title);
        if (ImGui::TreeNodeEx(title, ImGuiTreeNodeFlags_DefaultOpen)) {
            changed |= draw_yarn(yarn, cloth.bands);
            ImGui::TreePop();
        }
        ImGui::PopID();
    };
    if (cloth.draft.warp_yarns.empty())
        system("Warp", cloth.warp);
    if (cloth.draft.weft_yarns.empty())
        system("Weft", cloth.weft);
    for (NamedYarn& named : cloth.yarns)
        system(named.name.c_str(), named.yarn);
    return changed;
}

bool pick_colourway(const ClothTable& table, std::string& colourway) {
    if (table.dyed.size() < 2)
        return false;
    bool picked = false;
    if (!ImGui::BeginCombo("colourway", colourway.empty() ? "its own" : colourway.c_str()))
        return false;
    for (const auto& [name, bsdf] : table.dyed)
        if (ImGui::Selectable(name.empty() ? "its own" : name.c_str(), name == colourway)) {
            picked = name != colourway;
            colourway = name;
        }
    ImGui::EndCombo();
    return picked;
}

} // namespace rapport
