#include "materials/table/bsdf_table.h"
#include "materials/table/export_csv.h"
#include "materials/table/export_measured.h"
#include "materials/table/export_radiance.h"
#include "renderer/app/commands.h"

#include <fmt/format.h>
#include <functional>
#include <map>
#include <memory>

namespace rapport {
namespace {

struct ExportOptions {
    std::string table, format, output;
};

void to_csv(const BsdfTable& table, const ExportOptions&, const std::filesystem::path& path) {
    export_csv(table, path);
}

template <MeasuredColours colours>
void to_measured(const BsdfTable& table, const ExportOptions& options,
                 const std::filesystem::path& path) {
    const MeasuredLosses losses = export_measured(table, options.table, colours, path);
    fmt::print(
        "of the light of an even sky: kept {:.4f} (scattered back by the face); lost {:.4f} "
        "scattered through, {:.4f} unscattered, and of light on the back {:.4f} scattered "
        "back, {:.4f} through\n"
        "resolution: RMS difference {:.4f} of the mean, albedo within {:.4f}, in {:.1f} MB\n",
        losses.kept, losses.transmitted, losses.unscattered, losses.back_reflected,
        losses.back_transmitted, losses.resolution, losses.largest_albedo_error,
        1e-6 * static_cast<double>(std::filesystem::file_size(path)));
}

void to_radiance(const BsdfTable& table, const ExportOptions& options,
                 const std::filesystem::path& path) {
    const RadianceLosses losses = export_radiance(table, options.table, path);
    fmt::print("{} numbers; the share of light that leaves is within {:.4f} of the table's\n",
               losses.values, losses.largest_flux_error);
}

struct Format {
    const char* ending; ///< of the file, in place of the table's own
    std::function<void(const BsdfTable&, const ExportOptions&, const std::filesystem::path&)> write;
};

const std::map<std::string, Format>& formats() {
    static const std::map<std::string, Format> all{
        {"csv", {".csv", to_csv}},
        {"mitsuba", {".mitsuba.bsdf", to_measured<MeasuredColours::rgb>}},
        {"pbrt", {".pbrt.bsdf", to_measured<MeasuredColours::spectra>}},
        {"radiance", {".xml", to_radiance}}};
    return all;
}

void run(const ExportOptions& options) {
    const Format& format = formats().at(options.format);
    const BsdfTable table = read_table(options.table);
    const std::filesystem::path output =
        options.output.empty()
            ? std::filesystem::path(options.table).filename().replace_extension(format.ending)
            : std::filesystem::path(options.output);
    format.write(table, options, output);
    fmt::print("{}\n", output.string());
}

} // namespace

void add_export_command(CLI::App& app) {
    const auto options = std::make_shared<ExportOptions>();
    CLI::App* command = app.add_subcommand("export", "Write a BSDF table in another format");
    command->add_option("table", options->table, "BSDF table (.bsdf)")->required();
    std::vector<std::string> names;
    for (const auto& [name, format] : formats())
        names.push_back(name);
    command->add_option("--to", options->format, "Format")->required()->check(CLI::IsMember(names));
    command->add_option("-o,--output", options->output,
                        "File to write (default: beside you, named as the table)");
    command->callback([options] { run(*options); });
}

} // namespace rapport
