#include "materials/table/bsdf_table.h"
#include "materials/table/export_csv.h"
#include "renderer/app/commands.h"

#include <fmt/format.h>
#include <memory>

namespace rapport {
namespace {

struct ExportOptions {
    std::string table, format, output;
};

void run(const ExportOptions& options) {
    const BsdfTable table = read_table(options.table);
    const std::filesystem::path output = options.output.empty()
                                             ? std::filesystem::path(options.table)
                                                   .filename()
                                                   .replace_extension("." + options.format)
                                             : std::filesystem::path(options.output);
    export_csv(table, output);
    fmt::print("{}\n", output.string());
}

} // namespace

void add_export_command(CLI::App& app) {
    const auto options = std::make_shared<ExportOptions>();
    CLI::App* command = app.add_subcommand("export", "Write a BSDF table in another format");
    command->add_option("table", options->table, "BSDF table (.bsdf)")->required();
    command->add_option("--to", options->format, "Format")
        ->required()
        ->check(CLI::IsMember({"csv"}));
    command->add_option("-o,--output", options->output, "File to write (default: TABLE.csv)");
    command->callback([options] { run(*options); });
}

} // namespace rapport
