#include "vgsp/colourway_text.h"

#include "vgsp/yarn_text.h"

#include <algorithm>
#include <fmt/format.h>

namespace rapport {
namespace {

constexpr size_t kMostColourways = 32;
constexpr std::string_view kYarnPlace = "yarn."; ///< of named yarns, before the name

Dye read_yarn_dye(const TomlReader& file, std::string_view key, size_t bands) {
    const TomlReader table = file.table(key);
    table.allow_only({"color", "absorption_per_um"});
    const Dye dye = read_dye(table, bands);
    if (dye == Dye{})
        file.fail(key, "'color' or 'absorption_per_um'", "none");
    return dye;
}

/// `yarns` are the names of all yarns that the file describes.
std::map<std::string, Dye> read_colourway(const TomlReader& file, const Cloth& cloth,
                                          const std::vector<std::string>& yarns) {
    const std::vector<YarnKind> kinds = yarn_kinds(cloth);
    const auto woven = [&](const std::string& place) {
        return std::ranges::find(kinds, place, &YarnKind::place) != kinds.end();
    };
    std::map<std::string, Dye> dyes;
    std::vector<std::string_view> keys;
    for (const char* system : {"warp", "weft"})
        if (woven(system)) {
            keys.push_back(system);
            if (file.has(system))
                dyes[system] = read_yarn_dye(file, system, cloth.bands.count());
        }
    if (!yarns.empty())
        keys.push_back("yarn");
    file.allow_only(keys);
    if (file.has("yarn")) {
        const TomlReader named = file.table("yarn");
        named.allow_only({yarns.begin(), yarns.end()});
        for (const std::string& name : named.keys()) {
            const std::string place = std::string(kYarnPlace) + name;
            const Dye dye = read_yarn_dye(named, name, cloth.bands.count());
            if (woven(place)) // another draft may do without
                dyes[place] = dye;
        }
    }
    return dyes;
}

} // namespace

Cloth::ColourwayDyes read_colourways(const TomlReader& file, const Cloth& cloth) {
    Cloth::ColourwayDyes colourways;
    if (!file.has("colourway"))
        return colourways;
    const TomlReader described = file.table("colourway");
    const std::vector<std::string> names = described.keys();
    if (names.size() > kMostColourways)
        file.fail("colourway", fmt::format("at most {} colourways", kMostColourways),
                  fmt::format("{}", names.size()));
    const std::vector<std::string> yarns =
        file.has("yarn") ? file.table("yarn").keys() : std::vector<std::string>();
    for (const std::string& name : names) {
        if (name.empty())
            described.fail(name, "a name for the colourway", "none");
        colourways[name] = read_colourway(described.table(name), cloth, yarns);
    }
    return colourways;
}

toml::table colourway_table(const Cloth::ColourwayDyes& colourways) {
    toml::table table;
    for (const auto& [name, dyes] : colourways) {
        toml::table colourway, yarns;
        for (const auto& [place, dye] : dyes) {
            toml::table of_yarn;
            add_dye(dye, of_yarn);
            if (place.starts_with(kYarnPlace))
                yarns.insert(place.substr(kYarnPlace.size()), std::move(of_yarn));
            else
                colourway.insert(place, std::move(of_yarn));
        }
        if (!yarns.empty())
            colourway.insert("yarn", std::move(yarns));
        table.insert(name, std::move(colourway));
    }
    return table;
}

} // namespace rapport
