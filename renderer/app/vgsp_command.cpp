#include "materials/table/bsdf_table.h"
#include "renderer/app/commands.h"
#include "renderer/app/info.h"
#include "renderer/app/measuring_line.h"
#include "renderer/app/scan_files.h"
#include "renderer/core/atomic_file.h"
#include "renderer/core/error.h"
#include "renderer/core/input_file.h"
#include "vgsp/measure_cloth.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <fmt/format.h>
#include <memory>
#include <optional>

namespace rapport {
namespace {

struct VgspOptions {
    std::string cloth, draft, output, side = "both";
    std::vector<std::string> incidence;
    std::vector<double> planes, theta_in;
    std::optional<int> realisations; ///< kUsualRealisations, or as many as kUsualMemory holds
    bool resume = false;
    GoniophotometerSettings settings;
};

constexpr int kUsualRealisations = 4;
constexpr double kUsualMemory = 1e9; ///< bytes, unless realisations are asked for

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
    measure.realisations = options.realisations.value_or(kUsualRealisations);
    measure.memory = options.realisations ? kMostMemory : kUsualMemory;
    measure.front = options.side != "back";
    measure.back = options.side != "front";
    for (const Side side : {Side::front, Side::back})
        if (side == Side::front ? measure.front : measure.back)
            for (const std::string& text : options.incidence)
                measure.incidence.push_back(parse_incidence(text, side));
    return measure;
}

/// --plane and --theta-in: plane by plane, and in each the angles in the order asked for.
std::vector<IncidentDirection> scan_incidence(const VgspOptions& options) {
    std::vector<IncidentDirection> incident;
    for (const Side side : {Side::front, Side::back})
        if (side == Side::front ? options.side != "back" : options.side != "front")
            for (const double plane : options.planes)
                for (const double theta : options.theta_in)
                    incident.push_back({side, radians(theta), radians(plane)});
    return incident;
}

void warn_of_fewer(size_t realisations, const MicroElement& element, const MeasureOptions& measure,
                   const VgspOptions& options, bool quiet) {
    if (!quiet && realisations < static_cast<size_t>(measure.realisations))
        fmt::print(stderr,
                   "{}: {} of {} realisations: each takes {:.2g} GB, all may take {:.2g}{}\n",
                   options.cloth, realisations, measure.realisations, element.memory * 1e-9,
                   measure.memory * 1e-9,
                   options.realisations ? "" : " unless --realisations asks for more");
}

/// What is written: a scan's OUT.csv and OUT.svg, whichever of the two `output` names, or a table
/// and its checkpoint.
using OutputFiles = std::array<std::filesystem::path, 2>;
OutputFiles output_files(const std::filesystem::path& output, bool scanning) {
    OutputFiles files{output, output};
    if (!scanning) {
        files[1] += ".part";
        return files;
    }
    const std::string extension = lower_extension(output);
    if (extension != ".csv" && extension != ".svg")
        throw FileError("command line", "--output", "a .csv or .svg for a scan", output.string());
    return {files[0].replace_extension(".csv"), files[1].replace_extension(".svg")};
}

void scan(const Cloth& cloth, const OutputFiles& files, const VgspOptions& options,
          const MeasureOptions& measure,
          const std::function<void(const GoniophotometerProgress&)>& watch, bool quiet) {
    const GoniophotometerSettings& settings = measure.goniophotometer;
    const Realisations realisations =
        build_realisations(cloth, {.seed = settings.seed}, measure.realisations, measure.memory);
    warn_of_fewer(realisations.tracers.size(), realisations.first, measure, options, quiet);
    const std::vector<PlaneScan> scans = scan_planes(
        realisations.tracers, cloth_optics(cloth, realisations.tracers[0], settings).fibres,
        cloth.bands, scan_incidence(options), settings, watch);
    double accuracy = 0, spread = 0;
    for (const PlaneScan& each : scans) {
        accuracy = std::max(accuracy, each.accuracy);
        spread = std::max(spread, each.realisation_error.value_or(0));
    }
    const auto& [csv, svg] = files;
    // The one within the other: both appear, or none.
    write_stream_atomically(csv, [&](std::ofstream& stream) {
        stream << scan_csv(scans);
        write_stream_atomically(svg, [&](std::ofstream& drawing) { drawing << scan_svg(scans); });
    });
    for (const std::filesystem::path& path : files)
        if (!quiet)
            fmt::print("{}: accuracy {:.4f} on {} angles of exit, {} incident directions{}\n",
                       path.string(), accuracy, 2 * PlaneScan::kAngles, scans.size(),
                       realisations.tracers.size() > 1 ? fmt::format(", realisation {:.4f}", spread)
                                                       : "");
}

void run(const VgspOptions& options, const CommonOptions& common) {
    const std::filesystem::path path = options.cloth;
    MeasureOptions measure = measure_options(options, common);
    const bool bare_draft = lower_extension(path) == ".wif";
    if (bare_draft && !options.draft.empty())
        throw FileError("command line", "--draft", "a cloth .toml to weave it with", path.string());
    const Cloth cloth =
        bare_draft ? viscose_cloth(path)
                   : read_cloth(path, options.draft.empty()
                                          ? std::nullopt
                                          : std::optional<std::filesystem::path>(options.draft));
    if (bare_draft && !common.quiet)
        fmt::print(stderr, "{}: a draft alone; woven as the built-in viscose cloth\n",
                   path.string());
    if (!common.quiet)
        for (const std::string& warning : cloth.draft.warnings)
            fmt::print(stderr, "warning: {}\n", warning);

    const bool scanning = !options.planes.empty();
    const std::filesystem::path output =
        options.output.empty() ? path.filename().replace_extension(scanning ? ".csv" : ".bsdf")
                               : std::filesystem::path(options.output);
    const OutputFiles files = output_files(output, scanning);
    std::ranges::for_each(files, check_writable);
    MeasuringLine line(common);
    const auto watch = [&](const GoniophotometerProgress& progress) {
        line.update(path, progress);
    };
    // A scan is of single directions, each ready after minutes: to ask for fewer at a time keeps
    // what is done as well as a checkpoint would.
    if (scanning && options.resume)
        throw FileError("command line", "--resume",
                        "a table: a scan keeps no checkpoint, ask for fewer --plane and --theta-in "
                        "at a time",
                        "a scan");
    if (scanning && !cloth.colourways.empty())
        throw FileError(path.string(), "colourway",
                        "none for a scan: it tells of one set of dyes (--incidence of all)",
                        fmt::format("{}", cloth.colourways.size()));
    if (scanning)
        return scan(cloth, files, options, measure, watch, common.quiet);
    measure.checkpoint = {files[1], options.resume};
    if (options.resume && !common.quiet && !std::filesystem::exists(measure.checkpoint.path))
        fmt::print(stderr, "{}: not there, so the measurement starts from the beginning\n",
                   measure.checkpoint.path.string());
    const ClothMeasurement result = measure_cloth(cloth, measure, watch);
    line.end();
    write_table(result.table, output);
    if (!result.counts.out_of_time && !result.counts.out_of_paths)
        std::filesystem::remove(measure.checkpoint.path);
    if (common.quiet)
        return;
    warn_of_fewer(result.realisations, result.element, measure, options, common.quiet);
    const BsdfTable& table = result.table;
    fmt::print("{}: accuracy {:.4f} on {} bins, {} incident directions, {} paths{}\n{}\n",
               output.string(), table.largest_accuracy(), 2 * table.exits.bins(),
               table.directions(), result.counts.paths,
               result.counts.out_of_time    ? ", out of time; --resume goes on"
               : result.counts.out_of_paths ? ", out of rays; --resume with more goes on"
                                            : "",
               error_text(table.largest_error()));
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
        ->check(positive_number());
    CLI::Option* const incidence = command->add_option(
        "--incidence", options->incidence,
        "Measure only this direction of light, THETA,PHI in degrees (repeatable)");
    incidence->allow_extra_args(false);
    CLI::Option* const plane =
        command
            ->add_option("--plane", options->planes,
                         "Scan only the plane of light from this azimuth, in degrees (repeatable): "
                         "intensity over the angle of exit, to a .csv and an .svg")
            ->allow_extra_args(false)
            ->check(finite_number(0, 360))
            ->excludes(incidence);
    CLI::Option* const theta_in =
        command
            ->add_option("--theta-in", options->theta_in,
                         "Polar angle of the light in a scan, in degrees (repeatable)")
            ->allow_extra_args(false)
            ->check(finite_number(0, 89.9))
            ->needs(plane);
    plane->needs(theta_in);
    command->add_option("--side", options->side, "Side the light arrives on (default both)")
        ->check(CLI::IsMember({"front", "back", "both"}));
    command
        ->add_option(
            "--realisations", options->realisations,
            "Realisations of the cloth's random fibres that are averaged (default 4, or as many "
            "as 1 GB holds)")
        ->check(CLI::Range(1, 1024));
    command
        ->add_option("--max-rays", options->settings.max_paths,
                     "Incident paths per direction at most; where more were wanted, OUTPUT.part is "
                     "kept for --resume")
        ->check(whole_number(1));
    command
        ->add_option("--max-time", options->settings.max_seconds,
                     "Seconds at most; the table is written with the accuracy reached, and "
                     "OUTPUT.part kept for --resume")
        ->check(positive_number());
    command->add_flag("--resume", options->resume,
                      "Go on with a measurement that was interrupted, from OUTPUT.part (no scan)");
    command->callback([options, &common] { run(*options, common); });
}

} // namespace rapport
