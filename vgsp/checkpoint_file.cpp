#include "vgsp/checkpoint_file.h"

#include "renderer/core/error.h"
#include "renderer/core/tensor_file.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace rapport {
namespace {

/// All by which one run is told from another.
nlohmann::json identity(const BsdfTable& table) {
    nlohmann::json run = table.metadata;
    auto& incident = run["incident directions"] = nlohmann::json::array();
    for (const IncidentDirection& from : table.incident)
        incident.push_back({from.side == Side::front ? "front" : "back", from.theta, from.phi});
    run["exit bins"] = {table.exits.columns(), table.exits.rows()};
    auto& colourways = run["colourways"] = nlohmann::json::array();
    for (const auto& [name, dyes] : table.colourways)
        colourways.push_back(name);
    return run;
}

/// A value for a message.
std::string excerpt(const nlohmann::json& run, const std::string& key) {
    if (!run.contains(key))
        return "nothing";
    const std::string text = run[key].is_string() ? run[key].get<std::string>() : run[key].dump();
    const size_t end = text.find('\n');
    return end < 60 || text.size() > 60 ? text.substr(0, std::min<size_t>(end, 60)) + " …" : text;
}

/// FileError naming the first thing that differs.
void check_same_run(const nlohmann::json& expected, const nlohmann::json& found,
                    const std::string& path) {
    if (!found.is_object())
        throw FileError(path, "run", "a JSON object", found.type_name());
    for (const nlohmann::json& one : {expected, found})
        for (const auto& [key, value] : one.items())
            if (!expected.contains(key) || !found.contains(key) || expected[key] != found[key])
                throw FileError(
                    path, key,
                    fmt::format("the checkpoint of this run ({})", excerpt(expected, key)),
                    excerpt(found, key));
}

template <class T>
std::vector<T> array(const TensorFile& file, const std::string& name,
                     const std::vector<uint64_t>& shape, const std::string& path) {
    const auto found = file.find(name);
    if (found == file.end())
        throw FileError(path, name, "an array of that name", "none");
    const TensorField like = TensorField::of<T>({0}, {});
    if (found->second.type != like.type || found->second.shape != shape)
        throw FileError(path, name, "an array laid out as this run's", "another type or shape");
    return found->second.template values<T>();
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
    file["run"] = TensorField::text(identity(table).dump());
    file["planned"] =
        TensorField::of<uint64_t>({planned.size()}, std::vector(planned.begin(), planned.end()));
    file["sums"] = TensorField::of<double>({rows, sums.size() / rows}, sums);
    file["path_counts"] = TensorField::of<uint64_t>({rows, counts.size() / rows}, counts);
    write_tensor_file(file, path);
}

void read_checkpoint(const std::filesystem::path& path, const BsdfTable& table,
                     std::vector<uint64_t>& planned, std::span<PathTally> tallies) {
    const std::string name = path.string();
    const TensorFile file = read_tensor_file(path);
    const auto run = file.find("run");
    if (run == file.end() || run->second.type != TensorField::Type::u8)
        throw FileError(name, "run", "the checkpoint of a measurement", "another kind of file");
    check_same_run(identity(table), nlohmann::json::parse(run->second.text(), nullptr, false),
                   name);
    const uint64_t directions = table.directions(), rows = tallies.size();
    const size_t own_sums = tallies[0].sums().size();
    const size_t own_counts = tallies[0].path_counts().size();
    planned = array<uint64_t>(file, "planned", {directions}, name);
    const auto sums = array<double>(file, "sums", {rows, own_sums}, name);
    const auto counts = array<uint64_t>(file, "path_counts", {rows, own_counts}, name);
    for (size_t row = 0; row < rows; ++row) {
        tallies[row].restore(std::span(sums).subspan(row * own_sums, own_sums),
                             std::span(counts).subspan(row * own_counts, own_counts));
        const size_t d = row / (rows / directions);
        if (tallies[row].paths() > planned[d])
            throw FileError(name, fmt::format("planned[{}]", d),
                            fmt::format("at least {} paths", tallies[row].paths()),
                            fmt::format("{}", planned[d]));
    }
}

} // namespace rapport
