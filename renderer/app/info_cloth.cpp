#include "renderer/app/info.h"
#include "vgsp/cloth.h"
#include "vgsp/micro_element.h"

#include <algorithm>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <iterator>
#include <ranges>

namespace rapport {
namespace {

/// A drawdown wider than this is told in numbers only.
constexpr int kWidestPicture = 64;

/// Two picks to a line, by whether the warp is up in the upper and in the lower one.
constexpr const char* kHalfBlocks[2][2] = {{" ", "▄"}, {"▀", "█"}};

nlohmann::ordered_json draft_json(const Draft& draft, const char* kind) {
    nlohmann::ordered_json json;
    json["kind"] = kind;
    json["ends"] = draft.ends;
    json["picks"] = draft.picks;
    json["rows"] = draft_rows(draft);
    json["warnings"] = draft.warnings;
    return json;
}

std::string draft_text(const Draft& draft) {
    std::string text = fmt::format("{} ends × {} picks\n", draft.ends, draft.picks);
    if (draft.ends <= kWidestPicture && draft.picks <= kWidestPicture)
        for (int pick = draft.picks - 1; pick >= 0; pick -= 2) { // pick 1 at the bottom
            const char* side = pick > 0 ? "│" : "╵"; // half as high beside a single pick
            text += side;
            for (int end = 0; end < draft.ends; ++end)
                text += kHalfBlocks[draft.up(end, pick)][pick > 0 && draft.up(end, pick - 1)];
            text += side + std::string("\n");
        }
    for (const std::string& warning : draft.warnings)
        text += "warning: " + warning + '\n';
    return text;
}

std::string twist_text(double per_m) {
    return per_m == 0
               ? std::string()
               : fmt::format(", {:.4g} turns per m {}", std::abs(per_m), per_m > 0 ? 'Z' : 'S');
}

std::string irregularity_text(const YarnSpec& yarn) {
    const Irregularity& irregularity = yarn.irregularity;
    std::string text;
    if (irregularity.migration_um > 0)
        text += fmt::format(", fibres wander {:g} µm and {:g}° (correlated over {:.3g} µm)",
                            irregularity.migration_um, irregularity.deviation_degrees,
                            irregularity.correlation_length_um());
    if (irregularity.spacing_jitter_um > 0)
        text += fmt::format(", places vary by {:g} µm", irregularity.spacing_jitter_um);
    if (yarn.fibre.diameter_variation > 0)
        text += fmt::format(", diameters by {:g} %", 100 * yarn.fibre.diameter_variation);
    if (irregularity.stray_fibres > 0)
        text += fmt::format(", {:g} % of the outer fibres stray", 100 * irregularity.stray_fibres);
    return text;
}

std::string yarn_text(const YarnSpec& yarn) {
    const bool plied = yarn.section == YarnSection::plied;
    std::string text =
        fmt::format("{}{} {} fibres of {:.4g} µm in {:.4g} × {:.4g} µm",
                    plied ? fmt::format("{} plies of ", yarn.plies) : "", yarn.fibres,
                    yarn.section == YarnSection::parallel ? "parallel" : "twisted",
                    yarn.fibre.diameter_um, yarn.width_um, yarn.height_um);
    text += twist_text(yarn.twist_per_m);
    if (plied)
        text +=
            ", plied" + (yarn.ply_twist_per_m == 0 ? std::string(" without twist")
                                                   : twist_text(yarn.ply_twist_per_m).substr(1));
    if (yarn.fibre.refractive_index.differs())
        text += fmt::format(", of index {} by band",
                            fmt::join(yarn.fibre.refractive_index.values(), ", "));
    if (yarn.fibre.roughness > 0)
        text += fmt::format(", rough by {:g}", yarn.fibre.roughness);
    return text + irregularity_text(yarn);
}

/// `named` has the named yarn of each thread, or is empty where all are `yarn`.
std::string system_text(const Cloth& cloth, const char* name, const YarnSpec& yarn,
                        const std::vector<int>& named, double per_cm, double cover, double crimp) {
    std::string text = fmt::format("{}: {} per cm, ", name, per_cm);
    for (size_t i = 0; i < cloth.yarns.size(); ++i)
        if (const auto threads = std::count(named.begin(), named.end(), int(i)); threads > 0)
            text += fmt::format("{} of {} {}, ", threads, named.size(), cloth.yarns[i].name);
    if (named.empty())
        text += yarn_text(yarn) + ", ";
    return text + fmt::format("cover {:.3f}, crimp {:.1f} %\n", cover, 100 * crimp);
}

} // namespace

Info draft_info(const std::filesystem::path& path) {
    const Draft draft = read_wif(path);
    return {draft_json(draft, "draft"), "Weave draft, " + draft_text(draft)};
}

Info cloth_info(const std::filesystem::path& path) {
    const Cloth cloth = read_cloth(path);
    const MicroElement element = build_micro_element(cloth);

    Info info;
    info.json = draft_json(cloth.draft, "cloth");
    info.json["name"] = cloth.name;
    info.json["bands"] = cloth.bands.names;
    info.json["micro_element"] = {{"cell_um", {element.fibres.cell.x, element.fibres.cell.y}},
                                  {"repeats", {element.repeats_x, element.repeats_y}},
                                  {"fibres", element.fibres.chains.size()},
                                  {"segments", element.segments},
                                  {"thickness_um", element.thickness_um},
                                  {"cover_warp", element.warp_cover},
                                  {"cover_weft", element.weft_cover},
                                  {"cover_factor", element.cover_factor},
                                  {"crimp_warp", element.crimp_warp},
                                  {"crimp_weft", element.crimp_weft},
                                  {"twist_rounding_warp", element.twist_rounding_warp},
                                  {"twist_rounding_weft", element.twist_rounding_weft},
                                  {"overlap_fraction", element.overlap_fraction},
                                  {"thinned", element.thinned}};
    if (element.mass_g_per_m2)
        info.json["micro_element"]["mass_g_per_m2"] = *element.mass_g_per_m2;

    info.text =
        fmt::format("Cloth \"{}\", bands {}\n", cloth.name, fmt::join(cloth.bands.names, ", ")) +
        draft_text(cloth.draft) +
        system_text(cloth, "warp", cloth.warp, cloth.draft.warp_yarns, cloth.ends_per_cm,
                    element.warp_cover, element.crimp_warp) +
        system_text(cloth, "weft", cloth.weft, cloth.draft.weft_yarns, cloth.picks_per_cm,
                    element.weft_cover, element.crimp_weft);
    for (const NamedYarn& yarn : cloth.yarns)
        info.text += fmt::format("yarn {}: {}\n", yarn.name, yarn_text(yarn.yarn));
    for (const auto& [name, dyes] : cloth.colourways) {
        info.json["colourways"].push_back(name);
        info.text +=
            fmt::format("colourway {}: {}\n", name,
                        dyes.empty() ? "as it is"
                                     : fmt::format("{} in other dyes",
                                                   fmt::join(std::views::keys(dyes), ", ")));
    }
    fmt::format_to(std::back_inserter(info.text),
                   "micro-element: {:.4g} × {:.4g} µm, {:.4g} µm thick, {} fibres, {} segments, "
                   "cover factor {:.3f}, {:.2f} % of the fibre surface overlaps\n",
                   element.fibres.cell.x, element.fibres.cell.y, element.thickness_um,
                   element.fibres.chains.size(), element.segments, element.cover_factor,
                   100 * element.overlap_fraction);
    if (element.thinned > 0)
        fmt::format_to(std::back_inserter(info.text),
                       "fibres thinned by {:.2f} % of their volume to keep clear of each other\n",
                       100 * element.thinned);
    if (element.mass_g_per_m2)
        fmt::format_to(std::back_inserter(info.text), "mass: {:.0f} g/m²\n",
                       *element.mass_g_per_m2);
    if (element.twist_rounding_warp != 0 || element.twist_rounding_weft != 0)
        fmt::format_to(std::back_inserter(info.text),
                       "twist rounded by {:+.2f} % (warp), {:+.2f} % (weft) to close over {} × {} "
                       "repeats\n",
                       100 * element.twist_rounding_warp, 100 * element.twist_rounding_weft,
                       element.repeats_x, element.repeats_y);
    return info;
}

} // namespace rapport
