#include "vgsp/cloth.h"

#include "renderer/core/error.h"
#include "renderer/core/input_file.h"
#include "renderer/core/math.h"
#include "vgsp/toml_reader.h"
#include "vgsp/weave.h"

#include <array>
#include <cmath>
#include <fmt/format.h>
#include <sstream>

namespace rapport {
namespace {

constexpr uint64_t kMaxFileBytes = 16 << 20;
constexpr double kInfinity = std::numeric_limits<double>::infinity();

constexpr Domain kShare{.low = 0, .high = 1};
constexpr Domain kSett{.low = 0, .high = 1000, .low_open = true};
constexpr Domain kYarnSize{.low = 0, .high = 10'000, .low_open = true};
constexpr Domain kTwist{.low = -100'000, .high = 100'000};
constexpr Domain kFlatten{.low = 0, .high = 1, .low_open = true};
constexpr Domain kFibreDiameter{.low = 0, .high = 1000, .low_open = true};
constexpr Domain kRefractiveIndex{.low = 1, .high = 4};
constexpr Domain kAbsorption{.low = 0, .high = kInfinity};
constexpr Domain kColor{.low = 0, .high = 1, .high_open = true};
constexpr Domain kWavelength{.low = 0, .high = kInfinity, .low_open = true};
constexpr Domain kFineness{.low = 0, .high = 10'000, .low_open = true};
constexpr Domain kDensity{.low = 0, .high = 25, .low_open = true};
constexpr Domain kVariation{.low = 0, .high = 0.3};
constexpr Domain kWandering{.low = 0, .high = 100};
constexpr Domain kDeviation{.low = 0, .high = 30};
constexpr int kMaxFibres = 10'000;
constexpr int kMaxPlies = 6;

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

/// Which of two keys the file has: exactly one.
std::string_view either(const TomlReader& file, std::string_view first, std::string_view second) {
    if (file.has(first) == file.has(second))
        file.fail(
            second,
            fmt::format("one of '{}' and '{}'", file.full_name(first), file.full_name(second)),
            file.has(first) ? "both" : "none");
    return file.has(first) ? first : second;
}

FibreSpec read_fibre(const TomlReader& file, size_t bands) {
    file.allow_only({"diameter_um", "dtex", "density_g_cm3", "diameter_variation",
                     "refractive_index", "absorption_per_um", "color", "surface_absorption"});
    FibreSpec fibre;
    if (file.has("density_g_cm3"))
        fibre.density_g_cm3 = file.number("density_g_cm3", kDensity);
    if (either(file, "diameter_um", "dtex") == "diameter_um") {
        fibre.diameter_um = file.number("diameter_um", kFibreDiameter);
    } else {
        fibre.diameter_um = fibre_diameter_um(file.number("dtex", kFineness),
                                              file.number("density_g_cm3", kDensity));
        if (!kFibreDiameter.contains(fibre.diameter_um))
            file.fail("dtex", fmt::format("a fibre of a diameter in {} µm", kFibreDiameter.text()),
                      fmt::format("{:g} µm", fibre.diameter_um));
    }
    fibre.diameter_variation = file.number("diameter_variation", kVariation, 0);
    fibre.refractive_index = file.number("refractive_index", kRefractiveIndex);
    if (file.has("absorption_per_um") && file.has("color"))
        file.fail("color", "one of 'absorption_per_um' and 'color'", "both");
    if (file.has("color"))
        fibre.color = file.numbers("color", kColor, bands);
    if (file.has("absorption_per_um"))
        fibre.absorption_per_um =
            file.is_array("absorption_per_um")
                ? file.numbers("absorption_per_um", kAbsorption, bands)
                : std::vector<double>(bands, file.number("absorption_per_um", kAbsorption));
    fibre.surface_absorption = file.number("surface_absorption", kShare, 0);
    return fibre;
}

/// The number of `fibre` that weighs as much as a yarn of `tex`.
int fibres_of(const TomlReader& file, const FibreSpec& fibre) {
    const double tex = file.number("tex", kFineness);
    if (!fibre.density_g_cm3)
        file.fail("tex", "'density_g_cm3' of the fibre beside 'tex'", "none");
    const double fibres =
        std::round(10 * tex / fibre_dtex(fibre.diameter_um, *fibre.density_g_cm3));
    if (!(fibres >= 1 && fibres <= kMaxFibres))
        file.fail("tex", fmt::format("the fineness of 1 … {} fibres", kMaxFibres),
                  fmt::format("that of {:g}", fibres));
    return int(fibres);
}

Irregularity read_irregularity(const TomlReader& file) {
    Irregularity irregularity;
    irregularity.migration_um = file.number("migration_um", kWandering, 0);
    irregularity.deviation_degrees = file.number("deviation_degrees", kDeviation, 0);
    irregularity.spacing_jitter_um = file.number("spacing_jitter_um", kWandering, 0);
    irregularity.stray_fibres = file.number("stray_fibres", kShare, 0);
    if ((irregularity.migration_um == 0) != (irregularity.deviation_degrees == 0))
        file.fail(irregularity.migration_um == 0 ? "deviation_degrees" : "migration_um",
                  "'migration_um' and 'deviation_degrees' together", "one of them");
    return irregularity;
}

YarnSpec read_yarn(const TomlReader& file, std::string_view sett_key, size_t bands) {
    constexpr std::array kParallelKeys{"width_um", "height_um"};
    constexpr std::array kTwistedKeys{"diameter_um", "twist_per_m"};
    constexpr std::array kPliedKeys{"diameter_um", "twist_per_m", "plies", "ply_twist_per_m"};
    std::vector<std::string_view> keys{sett_key,
                                       "section",
                                       "fibres",
                                       "tex",
                                       "flatten",
                                       "migration_um",
                                       "deviation_degrees",
                                       "spacing_jitter_um",
                                       "stray_fibres",
                                       "fibre"};
    const auto allow = [&](const auto& more) {
        keys.insert(keys.begin() + 2, more.begin(), more.end());
        file.allow_only(keys);
    };
    YarnSpec yarn;
    const std::string section = file.one_of("section", {"parallel", "twisted", "plied"});
    if (section == "parallel") {
        allow(kParallelKeys);
        yarn.section = YarnSection::parallel;
        yarn.width_um = file.number("width_um", kYarnSize);
        yarn.height_um = file.number("height_um", kYarnSize);
    } else {
        const bool plied = section == "plied";
        plied ? allow(kPliedKeys) : allow(kTwistedKeys);
        yarn.section = plied ? YarnSection::plied : YarnSection::twisted;
        yarn.width_um = yarn.height_um = file.number("diameter_um", kYarnSize);
        yarn.twist_per_m = file.number("twist_per_m", kTwist);
        if (plied) {
            yarn.plies = file.whole_number("plies", 2, kMaxPlies);
            yarn.ply_twist_per_m = file.number("ply_twist_per_m", kTwist);
        }
    }
    yarn.fibre = read_fibre(file.table("fibre"), bands);
    yarn.fibres = either(file, "fibres", "tex") == "tex"
                      ? fibres_of(file, yarn.fibre)
                      : file.whole_number("fibres", 1, kMaxFibres);
    yarn.flatten = file.number("flatten", kFlatten, 1);
    yarn.irregularity = read_irregularity(file);
    return yarn;
}

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

Cloth parse_cloth(std::string_view text, const std::filesystem::path& path,
                  const std::optional<std::filesystem::path>& draft_override) {
    const toml::table table = parse_toml(text, path.string());
    const TomlReader file(table, path.string());
    file.allow_only({"name", "draft", "weave", "rows", "crimp_balance", "bands", "warp", "weft"});

    Cloth cloth;
    cloth.path = path;
    cloth.name = file.has("name") ? file.text("name") : path.stem().string();
    cloth.crimp_balance = file.number("crimp_balance", kShare, cloth.crimp_balance);
    if (file.has("bands"))
        cloth.bands = read_bands(file.table("bands"));
    const TomlReader warp = file.table("warp"), weft = file.table("weft");
    cloth.warp = read_yarn(warp, "ends_per_cm", cloth.bands.count());
    cloth.weft = read_yarn(weft, "picks_per_cm", cloth.bands.count());
    cloth.ends_per_cm = warp.number("ends_per_cm", kSett);
    cloth.picks_per_cm = weft.number("picks_per_cm", kSett);

    PlacedDraft placed = draft_override
                             ? PlacedDraft{read_wif(*draft_override), draft_override->string()}
                             : read_draft(file, path);
    cloth.draft = std::move(placed.draft);
    cloth.draft.warnings = weavable(cloth.draft, placed.path).warnings;
    cloth.source = cloth_text(cloth);
    return cloth;
}

toml::array toml_array(const auto& values) {
    toml::array array;
    for (const auto& value : values)
        array.push_back(value);
    return array;
}

toml::table fibre_table(const FibreSpec& fibre) {
    toml::table table{{"diameter_um", fibre.diameter_um},
                      {"refractive_index", fibre.refractive_index},
                      {"surface_absorption", fibre.surface_absorption}};
    if (fibre.density_g_cm3)
        table.insert("density_g_cm3", *fibre.density_g_cm3);
    if (fibre.diameter_variation != 0)
        table.insert("diameter_variation", fibre.diameter_variation);
    if (fibre.absorption_per_um)
        table.insert("absorption_per_um", toml_array(*fibre.absorption_per_um));
    if (fibre.color)
        table.insert("color", toml_array(*fibre.color));
    return table;
}

toml::table yarn_table(const YarnSpec& yarn, const char* sett_key, double sett) {
    constexpr std::array kSections{"parallel", "twisted", "plied"};
    toml::table table{{sett_key, sett},
                      {"section", kSections[size_t(yarn.section)]},
                      {"fibres", yarn.fibres},
                      {"flatten", yarn.flatten},
                      {"fibre", fibre_table(yarn.fibre)}};
    if (yarn.section == YarnSection::parallel) {
        table.insert("width_um", yarn.width_um);
        table.insert("height_um", yarn.height_um);
    } else {
        table.insert("diameter_um", yarn.width_um);
        table.insert("twist_per_m", yarn.twist_per_m);
    }
    if (yarn.section == YarnSection::plied) {
        table.insert("plies", yarn.plies);
        table.insert("ply_twist_per_m", yarn.ply_twist_per_m);
    }
    const Irregularity& irregularity = yarn.irregularity;
    for (const auto& [key, value] : {std::pair("migration_um", irregularity.migration_um),
                                     {"deviation_degrees", irregularity.deviation_degrees},
                                     {"spacing_jitter_um", irregularity.spacing_jitter_um},
                                     {"stray_fibres", irregularity.stray_fibres}})
        if (value != 0)
            table.insert(key, value);
    return table;
}

} // namespace

double fibre_diameter_um(double dtex, double density_g_cm3) {
    return 20 * std::sqrt(dtex / (kPi * density_g_cm3));
}

double fibre_dtex(double diameter_um, double density_g_cm3) {
    return kPi * density_g_cm3 * square(diameter_um / 20);
}

double Irregularity::correlation_length_um() const {
    return migration_um == 0 ? kInfinity : migration_um / std::tan(radians(deviation_degrees));
}

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

std::string cloth_text(const Cloth& cloth) {
    toml::table table{{"name", cloth.name},
                      {"rows", toml_array(draft_rows(weavable(cloth.draft, cloth.path.string())))},
                      {"crimp_balance", cloth.crimp_balance},
                      {"warp", yarn_table(cloth.warp, "ends_per_cm", cloth.ends_per_cm)},
                      {"weft", yarn_table(cloth.weft, "picks_per_cm", cloth.picks_per_cm)}};
    if (!cloth.bands.is_rgb())
        table.insert("bands", toml::table{{"edges_nm", toml_array(cloth.bands.edges_nm)}});
    std::ostringstream text;
    text << toml::toml_formatter(table) << '\n';
    return text.str();
}

} // namespace rapport
