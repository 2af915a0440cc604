#include "renderer/core/checkpoint.h"

#include <algorithm>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace rapport {
namespace {

/// A value for a message.
std::string excerpt(const nlohmann::json& run, const std::string& key) {
    if (!run.contains(key))
        return "nothing";
    const std::string text = run[key].is_string() ? run[key].get<std::string>() : run[key].dump();
    const size_t end = text.find('\n');
    return end < 60 || text.size() > 60 ? text.substr(0, std::min<size_t>(end, 60)) + " …" : text;
}

} // namespace

TensorField run_field(const nlohmann::json& run) {
    // Names of files may be anything but zero bytes; JSON is UTF-8.
    return TensorField::text(run.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace));
}

void check_same_run(const nlohmann::json& of_this, const TensorFile& file,
                    const std::filesystem::path& path) {
    const auto run = nlohmann::json::parse(run_field(of_this).text());
    const auto field = file.find("run");
    if (field == file.end() || field->second.type != TensorField::Type::u8)
        throw FileError(path.string(), "run", "the checkpoint of a run", "another kind of file");
    const auto found = nlohmann::json::parse(field->second.text(), nullptr, false);
    if (!found.is_object())
        throw FileError(path.string(), "run", "a JSON object", found.type_name());
    for (const nlohmann::json& one : {run, found})
        for (const auto& [key, value] : one.items())
            if (!run.contains(key) || !found.contains(key) || run[key] != found[key])
                throw FileError(path.string(), key,
                                fmt::format("the checkpoint of this run ({})", excerpt(run, key)),
                                excerpt(found, key));
}

} // namespace rapport
