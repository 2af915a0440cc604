#include "materials/table/bsdf_table.h"
#include "materials/table/export_csv.h"
#include "materials/table/export_measured.h"
#include "materials/table/export_radiance.h"
#include "renderer/app/commands.h"
#include "renderer/core/progress.h"

#include <fmt/format.h>
#include <functional>
#include <iostream>
#include <map>
#include <memory>
#include <optional>

namespace rapport {
namespace {

struct ExportOptions {
    std::string table, format, output;
};

// Each writes the table that is read from `name` to `path`, and tells in lines what was lost.

std::string to_csv(const BsdfTable& table, const std::string&, const std::filesystem::path& path,
                   const ProgressSignal&) {
    export_csv(table, path);
    return {};
}

template <MeasuredColours colours>
std::string to_measured(const BsdfTable& table, const std::string& name,
                        const std::filesystem::path& path, const ProgressSignal& progress) {
    const MeasuredLosses losses = export_measured(table, name, colours, path, progress);
    return fmt::format(
        "of the light of an even sky: kept {:.4f} (scattered back by the face); lost {:.4f} "
        "scattered through, {:.4f} unscattered, and of light on the back {:.4f} scattered "
        "back, {:.4f} through\n"
        "resolution: RMS difference {:.4f} of the mean, albedo within {:.4f}, in {:.1f} MB\n",
        losses.kept, losses.transmitted, losses.unscattered, losses.back_reflected,
        losses.back_transmitted, losses.resolution, losses.largest_albedo_error,
        1e-6 * static_cast<double>(std::filesystem::file_size(path)));
}

std::string to_radiance(const BsdfTable& table, const std::string& name,
                        const std::filesystem::path& path, const ProgressSignal& progress) {
    const RadianceLosses losses = export_radiance(table, name, path, progress);
    return fmt::format(
        "{} numbers; the share of light that leaves is within {:.4f} of the table's\n",
        losses.values, losses.largest_flux_error);
}

struct Format {
    const char* ending; ///< of the file, in place of the table's own
    std::function<std::string(const BsdfTable&, const std::string&, const std::filesystem::path&,
                              const ProgressSignal&)>
        write;
};

const std::map<std::string, Format>& formats() {
    static const std::map<std::string, Format> all{
        {"csv", {".csv", to_csv}},
        {"mitsuba", {".mitsuba.bsdf", to_measured<MeasuredColours::rgb>}},
        {"pbrt", {".pbrt.bsdf", to_measured<MeasuredColours::spectra>}},
        {"radiance", {".xml", to_radiance}}};
    return all;
}

void run(const ExportOptions& options, const CommonOptions& common) {
    const Format& format = formats().at(options.format);
    const BsdfTable table = read_table(options.table);
    const std::filesystem::path output =
        options.output.empty()
            ? std::filesystem::path(options.table).filename().replace_extension(format.ending)
            : std::filesystem::path(options.output);
    std::optional<ProgressLine> line;
    if (shows_progress(common))
        line.emplace(std::cerr, "writing " + output.filename().string());
    const std::string losses = format.write(table, options.table, output, [&](double fraction) {
        if (line)
            line->update(fraction);
    });
    line.reset();
    fmt::print("{}{}\n", losses, output.string());
}

} // namespace

void add_export_command(CLI::App& app, const CommonOptions& common) {
    const auto options = std::make_shared<ExportOptions>();
    CLI::App* command = app.add_subcommand("export", "Write a BSDF table in another format");
    command->add_option("table", options->table, "BSDF table (.bsdf)")->required();
    std::vector<std::string> names;
    for (const auto& [name, format] : formats())
        names.push_back(name);
    command->add_option("--to", options->format, "Format")->required()->check(CLI::IsMember(names));
    command->add_option("-o,--output", options->output,
                        "File to write (default: beside you, named as the table)");
    command->callback([options, &common] { run(*options, common); });
}

} // namespace rapport
