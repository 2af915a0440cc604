#include "materials/table/bsdf_table.h"
#include "renderer/app/commands.h"
#include "renderer/core/error.h"
#include "renderer/core/progress.h"
#include "vgsp/measure_cloth.h"

#include <charconv>
#include <fmt/format.h>
#include <iostream>
#include <memory>
#include <optional>

namespace rapport {
namespace {

struct VgspOptions {
    std::string cloth, draft, output, side = "both";
    std::vector<std::string> incidence;
    GoniophotometerSettings settings;
};

/// "θ,φ" in degrees; θ is measured from the normal of the side that is asked for.
IncidentDirection parse_incidence(const std::string& text, Side side) {
    double values[2];
    const char* at = text.data();
    const char* const end = at + text.size();
    for (int i = 0; i < 2; ++i) {
        const auto [next, error] = std::from_chars(at, end, values[i]);
        const bool separated = i == 0 ? next != end && *next == ',' : next == end;
        if (error != std::errc() || !separated || !std::isfinite(values[i]))
            throw FileError("command line", "--incidence", "two angles in degrees, as in 30,45",
                            text);
        at = next + 1;
    }
    if (values[0] < 0 || values[0] >= 90)
        throw FileError("command line", "--incidence", "a polar angle in [0, 90)", text);
    double phi = std::fmod(values[1], 360.0);
    if (phi < 0)
        phi += 360;
    return {side, radians(values[0]), radians(phi)};
}

MeasureOptions measure_options(const VgspOptions& options, const CommonOptions& common) {
    MeasureOptions measure;
    measure.goniophotometer = options.settings;
    measure.goniophotometer.seed = common.seed;
    measure.front = options.side != "back";
    measure.back = options.side != "front";
    for (const Side side : {Side::front, Side::back})
        if (side == Side::front ? measure.front : measure.back)
            for (const std::string& text : options.incidence)
                measure.incidence.push_back(parse_incidence(text, side));
    return measure;
}

void run(const VgspOptions& options, const CommonOptions& common) {
    const std::filesystem::path path = options.cloth;
    const MeasureOptions measure = measure_options(options, common);
    const bool bare_draft = lower_extension(path) == ".wif";
    if (bare_draft && !options.draft.empty())
        throw FileError("command line", "--draft", "a cloth .toml to weave it with", path.string());
    if (bare_draft && !common.quiet)
        fmt::print(stderr, "{}: a draft alone; woven as the built-in viscose cloth\n",
                   path.string());
    const Cloth cloth =
        bare_draft ? viscose_cloth(path)
                   : read_cloth(path, options.draft.empty()
                                          ? std::nullopt
                                          : std::optional<std::filesystem::path>(options.draft));
    if (!common.quiet)
        for (const std::string& warning : cloth.draft.warnings)
            fmt::print(stderr, "warning: {}\n", warning);

    const std::filesystem::path output = options.output.empty()
                                             ? path.filename().replace_extension(".bsdf")
                                             : std::filesystem::path(options.output);
    std::optional<ProgressLine> line;
    if (shows_progress(common))
        line.emplace(std::cerr, "measuring");
    const ClothMeasurement result =
        measure_cloth(cloth, measure, [&](const GoniophotometerProgress& progress) {
            if (line)
                line->update(progress.fraction,
                             fmt::format("accuracy {:.4f}, {:.0f} k paths/s", progress.accuracy,
                                         1e-3 * progress.paths_per_second),
                             progress.seconds_left);
        });
    line.reset();
    write_table(result.table, output);
    if (common.quiet)
        return;
    const BsdfTable& table = result.table;
    fmt::print("{}: accuracy {:.4f} on {} bins, {} incident directions, {} paths\n",
               output.string(), table.largest_accuracy(), 2 * table.exits.bins(),
               table.directions(), result.counts.paths);
}

} // namespace

void add_vgsp_command(CLI::App& app, const CommonOptions& common) {
    const auto options = std::make_shared<VgspOptions>();
    options->settings.accuracy = 0.02;
    CLI::App* command =
        app.add_subcommand("vgsp", "Measure a cloth in the virtual goniospectrophotometer");
    command->add_option("cloth", options->cloth, "Cloth .toml, or a bare .wif draft")->required();
    command->add_option("--draft", options->draft, "Weave this .wif instead of the cloth's draft");
    command->add_option("-o,--output", options->output,
                        "BSDF table to write (default: CLOTH.bsdf)");
    command
        ->add_option("--accuracy", options->settings.accuracy,
                     "RMS error of the intensity distribution over its mean, per incident "
                     "direction (default 0.02)")
        ->check(CLI::PositiveNumber);
    command->add_option("--incidence", options->incidence,
                        "Measure only this direction of light, THETA,PHI in degrees (repeatable)");
    command->add_option("--side", options->side, "Side the light arrives on (default both)")
        ->check(CLI::IsMember({"front", "back", "both"}));
    command->add_option("--max-rays", options->settings.max_paths,
                        "Incident paths per direction at most");
    command->add_option("--max-time", options->settings.max_seconds, "Seconds at most")
        ->check(CLI::PositiveNumber);
    command->callback([options, &common] { run(*options, common); });
}

} // namespace rapport
