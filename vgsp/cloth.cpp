#include "vgsp/cloth.h"

#include "renderer/core/error.h"
#include "renderer/core/input_file.h"
#include "vgsp/colourway_text.h"
#include "vgsp/weave.h"
#include "vgsp/yarn_text.h"

#include <charconv>
#include <fmt/format.h>
#include <map>
#include <numeric>
#include <sstream>

namespace rapport {
namespace {

constexpr uint64_t kMaxFileBytes = 16 << 20;
constexpr double kInfinity = std::numeric_limits<double>::infinity();

constexpr Domain kShare{.low = 0, .high = 1};
constexpr Domain kSett{.low = 0, .high = 1000, .low_open = true};
constexpr Domain kWavelength{.low = 0, .high = kInfinity, .low_open = true};

/// Artificial silk, after which the method was first tried. Fibres: 1.7 dtex at 1.52 g/cm³ is
/// 20·√(1.7/(π·1.52)) = 11.9 µm; index (1.539 + 2·1.519)/3 from Morton & Hearle's table. A bright
/// yarn of 37 filaments, 63 dtex, wider than high as untwisted filament yarns lie; its shape and
/// the sett, open enough for a plain weave of it, are guesses.
constexpr std::string_view kViscose = R"(
name = "viscose"
weave = "plain"

[warp]
ends_per_cm = 50
section = "parallel"
fibres = 37
width_um = 120
height_um = 80
[warp.fibre]
diameter_um = 11.9
refractive_index = 1.526

[weft]
picks_per_cm = 50
section = "parallel"
fibres = 37
width_um = 120
height_um = 80
[weft.fibre]
diameter_um = 11.9
refractive_index = 1.526
)";

Bands read_bands(const TomlReader& file) {
    file.allow_only({"edges_nm"});
    std::vector<double> edges = file.numbers_from("edges_nm", kWavelength, 2);
    for (size_t i = 1; i < edges.size(); ++i)
        if (edges[i] <= edges[i - 1])
            file.fail("edges_nm", "increasing wavelengths",
                      fmt::format("{} after {}", edges[i], edges[i - 1]));
    return Bands::from_edges(std::move(edges));
}

/// A draft, and the file that is to blame for it.
struct PlacedDraft {
    Draft draft;
    std::string path;
};

PlacedDraft read_draft(const TomlReader& file, const std::filesystem::path& path) {
    const char* key = nullptr;
    for (const char* candidate : {"draft", "weave", "rows"})
        if (file.has(candidate)) {
            if (key)
                file.fail(candidate, "one of 'draft', 'weave' and 'rows'",
                          fmt::format("'{}' beside '{}'", candidate, key));
            key = candidate;
        }
    if (!key)
        file.fail("draft", "one of 'draft', 'weave' and 'rows'", "none");
    if (key == std::string_view("draft")) {
        const std::string name = file.text(key);
        const std::filesystem::path draft = path.parent_path() / name;
        std::error_code error;
        if (!std::filesystem::is_regular_file(draft, error))
            file.fail(key, "a draft file", fmt::format("no file '{}'", draft.string()));
        return {read_wif(draft), draft.string()};
    }
    try {
        return {key == std::string_view("weave") ? named_weave(file.text(key))
                                                 : draft_from_rows(file.texts(key)),
                path.string()};
    } catch (const InvalidWeave& error) {
        file.fail(key, error.expected, error.found);
    }
}

/// What the file says of the yarns of the warp, or of the weft.
struct SystemText {
    std::optional<YarnSpec> yarn;       ///< one for all, or
    std::vector<std::string> order;     ///< names in turn, or
    std::map<int, std::string> colours; ///< the names by the draft's numbers of its colours
    double sett = 0;
};

SystemText read_system(const TomlReader& file, const char* sett_key,
                       const std::map<std::string, YarnSpec>& yarns, size_t bands) {
    SystemText system;
    const auto check_name = [&](const std::string& name, const TomlReader& at, const char* key) {
        if (!yarns.contains(name))
            at.fail(key, fmt::format("a yarn that the file describes: [yarn.{}]", name), "none");
    };
    if (file.has("order")) {
        file.allow_only({sett_key, "order"});
        system.order = file.texts("order");
        if (system.order.empty())
            file.fail("order", "names of yarns", "none");
        for (const std::string& name : system.order)
            check_name(name, file, "order");
    } else if (file.has("colors")) {
        file.allow_only({sett_key, "colors"});
        const TomlReader colours = file.table("colors");
        for (const std::string& key : colours.keys()) {
            int number = 0;
            const auto [end, error] = std::from_chars(key.data(), key.data() + key.size(), number);
            if (error != std::errc() || end != key.data() + key.size())
                colours.fail(key, "the number of a colour of the draft", "'" + key + "'");
            system.colours[number] = colours.text(key);
            check_name(system.colours[number], colours, key.c_str());
        }
    } else {
        system.yarn = read_yarn(file, {sett_key, "order", "colors"}, bands);
    }
    system.sett = file.number(sett_key, kSett);
    return system;
}

/// The named yarns that threads of the cloth are, in the order of their first thread.
class YarnNumbers {
  public:
    YarnNumbers(const std::map<std::string, YarnSpec>& described, std::vector<NamedYarn>& used)
        : described_(described), used_(used) {}

    int operator()(const std::string& name) {
        for (size_t i = 0; i < used_.size(); ++i)
            if (used_[i].name == name)
                return int(i);
        used_.push_back({name, described_.at(name)});
        return int(used_.size()) - 1;
    }

  private:
    const std::map<std::string, YarnSpec>& described_;
    std::vector<NamedYarn>& used_;
};

/// The yarn of each thread; nothing if all are alike.
std::vector<int> thread_yarns(const SystemText& system, const TomlReader& file, const Draft& draft,
                              const std::vector<int>& colours, int threads, YarnNumbers& number) {
    std::vector<int> yarns;
    for (int i = 0; i < threads && !system.order.empty(); ++i)
        yarns.push_back(number(system.order[size_t(i) % system.order.size()]));
    if (system.colours.empty())
        return yarns;
    if (colours.empty())
        file.fail("colors", "a draft that tells the colours of these threads (or 'order')",
                  "one that does not");
    for (const int colour : colours) {
        const int name = draft.palette_numbers[colour];
        const auto found = system.colours.find(name);
        if (found == system.colours.end())
            file.fail("colors", fmt::format("a yarn for colour {} of the draft", name), "none");
        yarns.push_back(number(found->second));
    }
    return yarns;
}

/// Lays the yarns into the draft, which is repeated as often as an order asks.
void lay_in_yarns(Cloth& cloth, const SystemText& warp, const SystemText& weft,
                  const std::map<std::string, YarnSpec>& described, const TomlReader& file,
                  const std::string& draft_path) {
    if (!warp.order.empty() || !weft.order.empty()) {
        Draft draft = weavable(cloth.draft, draft_path);
        const auto repeated = [&](int threads, const SystemText& system, const char* name) {
            const int64_t count =
                std::lcm(int64_t(threads), std::max<int64_t>(1, int64_t(system.order.size())));
            if (count > kMaxThreads)
                file.fail(name,
                          fmt::format("an order that repeats with the draft within {} threads",
                                      kMaxThreads),
                          fmt::format("{}", count));
            return int(count);
        };
        const int ends = repeated(draft.ends, warp, "warp");
        const int picks = repeated(draft.picks, weft, "weft");
        if (int64_t(ends) * picks > kMaxCrossings)
            file.fail("warp", fmt::format("orders that repeat within {} crossings", kMaxCrossings),
                      fmt::format("{} ends by {} picks", ends, picks));
        cloth.draft = tiled(draft, ends, picks);
    }
    Draft& draft = cloth.draft;
    YarnNumbers number(described, cloth.yarns);
    draft.warp_yarns =
        thread_yarns(warp, file.table("warp"), draft, draft.warp_colours, draft.ends, number);
    draft.weft_yarns =
        thread_yarns(weft, file.table("weft"), draft, draft.weft_colours, draft.picks, number);
}

Cloth parse_cloth(std::string_view text, const std::filesystem::path& path,
                  const std::optional<std::filesystem::path>& draft_override) {
    const toml::table table = parse_toml(text, path.string());
    const TomlReader file(table, path.string());
    file.allow_only({"name", "draft", "weave", "rows", "crimp_balance", "bands", "warp", "weft",
                     "yarn", "colourway"});

    Cloth cloth;
    cloth.path = path;
    cloth.name = file.has("name") ? file.text("name") : path.stem().string();
    cloth.crimp_balance = file.number("crimp_balance", kShare, cloth.crimp_balance);
    if (file.has("bands"))
        cloth.bands = read_bands(file.table("bands"));
    std::map<std::string, YarnSpec> yarns;
    if (file.has("yarn")) {
        const TomlReader described = file.table("yarn");
        for (const std::string& name : described.keys())
            yarns[name] = read_yarn(described.table(name), {}, cloth.bands.count());
    }
    const SystemText warp =
        read_system(file.table("warp"), "ends_per_cm", yarns, cloth.bands.count());
    const SystemText weft =
        read_system(file.table("weft"), "picks_per_cm", yarns, cloth.bands.count());
    cloth.warp = warp.yarn.value_or(YarnSpec{});
    cloth.weft = weft.yarn.value_or(YarnSpec{});
    cloth.ends_per_cm = warp.sett;
    cloth.picks_per_cm = weft.sett;

    PlacedDraft placed = draft_override
                             ? PlacedDraft{read_wif(*draft_override), draft_override->string()}
                             : read_draft(file, path);
    cloth.draft = std::move(placed.draft);
    cloth.draft.warnings = weavable(cloth.draft, placed.path).warnings;
    lay_in_yarns(cloth, warp, weft, yarns, file, placed.path);
    cloth.colourways = read_colourways(file, cloth);
    cloth.source = cloth_text(cloth);
    return cloth;
}

/// A system's table: of its one yarn, or the order of the named ones.
toml::table system_table(const Cloth& cloth, const YarnSpec& yarn, const std::vector<int>& order,
                         const char* sett_key, double sett) {
    toml::table table;
    if (order.empty()) {
        table = yarn_table(yarn);
    } else {
        std::vector<std::string> names;
        for (const int number : order)
            names.push_back(cloth.yarns[number].name);
        table.insert("order", toml_array(names));
    }
    table.insert(sett_key, sett);
    return table;
}

} // namespace

Cloth read_cloth(const std::filesystem::path& path,
                 const std::optional<std::filesystem::path>& draft_override) {
    InputFile file = open_input(path);
    if (file.size > kMaxFileBytes)
        throw FileError(path.string(), "",
                        fmt::format("a cloth of at most {} bytes", kMaxFileBytes),
                        fmt::format("{}", file.size));
    std::ostringstream text;
    text << file.stream.rdbuf();
    return parse_cloth(text.str(), path, draft_override);
}

Cloth viscose_cloth(const std::filesystem::path& draft_path) {
    return parse_cloth(kViscose, draft_path, draft_path);
}

Cloth load_cloth(const std::filesystem::path& path) {
    const std::string extension = lower_extension(path);
    if (extension == ".wif")
        return viscose_cloth(path);
    if (extension == ".toml")
        return read_cloth(path);
    throw FileError(path.string(), "", "a cloth as .toml or .wif",
                    extension.empty() ? "no extension" : extension);
}

std::vector<YarnKind> yarn_kinds(const Cloth& cloth) {
    std::vector<YarnKind> kinds;
    if (cloth.draft.warp_yarns.empty())
        kinds.push_back({"warp", &cloth.warp});
    if (cloth.draft.weft_yarns.empty())
        kinds.push_back({"weft", &cloth.weft});
    for (const NamedYarn& yarn : cloth.yarns)
        kinds.push_back({"yarn." + yarn.name, &yarn.yarn});
    return kinds;
}

std::string cloth_text(const Cloth& cloth) {
    const Draft draft = weavable(cloth.draft, cloth.path.string());
    toml::table table{{"name", cloth.name},
                      {"rows", toml_array(draft_rows(draft))},
                      {"crimp_balance", cloth.crimp_balance},
                      {"warp", system_table(cloth, cloth.warp, draft.warp_yarns, "ends_per_cm",
                                            cloth.ends_per_cm)},
                      {"weft", system_table(cloth, cloth.weft, draft.weft_yarns, "picks_per_cm",
                                            cloth.picks_per_cm)}};
    if (!cloth.bands.is_rgb())
        table.insert("bands", toml::table{{"edges_nm", toml_array(cloth.bands.edges_nm)}});
    if (!cloth.yarns.empty()) {
        toml::table yarns;
        for (const NamedYarn& yarn : cloth.yarns)
            yarns.insert(yarn.name, yarn_table(yarn.yarn));
        table.insert("yarn", std::move(yarns));
    }
    if (!cloth.colourways.empty())
        table.insert("colourway", colourway_table(cloth.colourways));
    std::ostringstream text;
    text << toml::toml_formatter(table) << '\n';
    return text.str();
}

} // namespace rapport
