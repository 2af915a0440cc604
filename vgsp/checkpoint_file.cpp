#include "vgsp/checkpoint_file.h"

#include "renderer/core/checkpoint.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace rapport {
namespace {

/// All by which one run is told from another. How far it may go is none of it.
nlohmann::json identity(const BsdfTable& table) {
    nlohmann::json run = table.metadata;
    run.erase("max_paths");
    auto& incident = run["incident directions"] = nlohmann::json::array();
    for (const IncidentDirection& from : table.incident)
        incident.push_back({from.side == Side::front ? "front" : "back", from.theta, from.phi});
    run["exit bins"] = {table.exits.columns(), table.exits.rows()};
    auto& colourways = run["colourways"] = nlohmann::json::array();
    for (const auto& [name, dyes] : table.colourways)
        colourways.push_back(name);
    return run;
}

} // namespace

void write_checkpoint(const std::filesystem::path& path, const BsdfTable& table,
                      std::span<const uint64_t> planned, std::span<const PathTally> tallies) {
    std::vector<double> sums;
    std::vector<uint64_t> counts;
    for (const PathTally& tally : tallies) {
        const std::vector<double> own = tally.sums();
        const std::vector<uint64_t> own_counts = tally.path_counts();
        sums.reserve(own.size() * tallies.size());
        sums.insert(sums.end(), own.begin(), own.end());
        counts.insert(counts.end(), own_counts.begin(), own_counts.end());
    }
    const uint64_t rows = tallies.size();
    TensorFile file;
    file["run"] = run_field(identity(table));
    file["planned"] =
        TensorField::of<uint64_t>({planned.size()}, std::vector(planned.begin(), planned.end()));
    file["sums"] = TensorField::of<double>({rows, sums.size() / rows}, sums);
    file["path_counts"] = TensorField::of<uint64_t>({rows, counts.size() / rows}, counts);
    write_tensor_file(file, path);
}

void read_checkpoint(const std::filesystem::path& path, const BsdfTable& table,
                     std::vector<uint64_t>& planned, std::span<PathTally> tallies) {
    const TensorFile file = read_tensor_file(path);
    check_same_run(identity(table), file, path);
    const uint64_t directions = table.directions(), rows = tallies.size();
    const size_t own_sums = tallies[0].sums().size();
    const size_t own_counts = tallies[0].path_counts().size();
    planned = checkpoint_array<uint64_t>(file, "planned", {directions}, path);
    const auto sums = checkpoint_array<double>(file, "sums", {rows, own_sums}, path);
    const auto counts = checkpoint_array<uint64_t>(file, "path_counts", {rows, own_counts}, path);
    for (size_t row = 0; row < rows; ++row) {
        tallies[row].restore(std::span(sums).subspan(row * own_sums, own_sums),
                             std::span(counts).subspan(row * own_counts, own_counts));
        const size_t d = row / (rows / directions);
        if (tallies[row].paths() > planned[d])
            throw FileError(path.string(), fmt::format("planned[{}]", d),
                            fmt::format("at least {} paths", tallies[row].paths()),
                            fmt::format("{}", planned[d]));
    }
}

} // namespace rapport
