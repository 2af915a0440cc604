#include "vgsp/yarn_text.h"

#include "renderer/core/math.h"

#include <array>
#include <cmath>
#include <fmt/format.h>

namespace rapport {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

constexpr Domain kShare{.low = 0, .high = 1};
constexpr Domain kYarnSize{.low = 0, .high = 10'000, .low_open = true};
constexpr Domain kTwist{.low = -100'000, .high = 100'000};
constexpr Domain kFlatten{.low = 0, .high = 1, .low_open = true};
constexpr Domain kFibreDiameter{.low = 0, .high = 1000, .low_open = true};
constexpr Domain kRefractiveIndex{.low = 1, .high = 4};
constexpr Domain kAbsorption{.low = 0, .high = kInfinity};
constexpr Domain kColor{.low = 0, .high = 1, .high_open = true};
constexpr Domain kFineness{.low = 0, .high = 10'000, .low_open = true};
constexpr Domain kDensity{.low = 0, .high = 25, .low_open = true};
constexpr Domain kVariation{.low = 0, .high = 0.3};
constexpr Domain kWandering{.low = 0, .high = 100};
constexpr Domain kDeviation{.low = 0, .high = 30};
constexpr int kMaxFibres = 10'000;
constexpr int kMaxPlies = 6;

toml::table fibre_table(const FibreSpec& fibre) {
    toml::table table{{"diameter_um", fibre.diameter_um},
                      {"surface_absorption", fibre.surface_absorption}};
    const std::vector<double>& index = fibre.refractive_index.values();
    if (index.size() == 1)
        table.insert("refractive_index", index[0]);
    else
        table.insert("refractive_index", toml_array(index));
    if (fibre.density_g_cm3)
        table.insert("density_g_cm3", *fibre.density_g_cm3);
    if (fibre.diameter_variation != 0)
        table.insert("diameter_variation", fibre.diameter_variation);
    if (fibre.roughness != 0)
        table.insert("roughness", fibre.roughness);
    add_dye(fibre, table);
    return table;
}

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
                     "refractive_index", "absorption_per_um", "color", "surface_absorption",
                     "roughness"});
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
    fibre.refractive_index = file.numbers_or_one("refractive_index", kRefractiveIndex, bands);
    static_cast<Dye&>(fibre) = read_dye(file, bands);
    fibre.surface_absorption = file.number("surface_absorption", kShare, 0);
    fibre.roughness = file.number("roughness", kShare, 0);
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

} // namespace

Dye read_dye(const TomlReader& file, size_t bands) {
    Dye dye;
    if (file.has("absorption_per_um") && file.has("color"))
        file.fail("color", "one of 'absorption_per_um' and 'color'", "both");
    if (file.has("color"))
        dye.color = file.numbers("color", kColor, bands);
    if (file.has("absorption_per_um")) {
        dye.absorption_per_um = file.numbers_or_one("absorption_per_um", kAbsorption, bands);
        dye.absorption_per_um->resize(bands, dye.absorption_per_um->front());
    }
    return dye;
}

void add_dye(const Dye& dye, toml::table& table) {
    if (dye.absorption_per_um)
        table.insert("absorption_per_um", toml_array(*dye.absorption_per_um));
    if (dye.color)
        table.insert("color", toml_array(*dye.color));
}

YarnSpec read_yarn(const TomlReader& file, std::vector<std::string_view> keys, size_t bands) {
    constexpr std::array kParallelKeys{"width_um", "height_um"};
    constexpr std::array kTwistedKeys{"diameter_um", "twist_per_m"};
    constexpr std::array kPliedKeys{"diameter_um", "twist_per_m", "plies", "ply_twist_per_m"};
    const auto allow = [&](const auto& of_section) {
        keys.insert(keys.end(), {"section", "fibres", "tex"});
        keys.insert(keys.end(), of_section.begin(), of_section.end());
        keys.insert(keys.end(), {"flatten", "migration_um", "deviation_degrees",
                                 "spacing_jitter_um", "stray_fibres", "fibre"});
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

toml::table yarn_table(const YarnSpec& yarn) {
    constexpr std::array kSections{"parallel", "twisted", "plied"};
    toml::table table{{"section", kSections[size_t(yarn.section)]},
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

double fibre_diameter_um(double dtex, double density_g_cm3) {
    return 20 * std::sqrt(dtex / (kPi * density_g_cm3));
}

double fibre_dtex(double diameter_um, double density_g_cm3) {
    return kPi * density_g_cm3 * square(diameter_um / 20);
}

double Irregularity::correlation_length_um() const {
    return migration_um == 0 ? kInfinity : migration_um / std::tan(radians(deviation_degrees));
}

} // namespace rapport
