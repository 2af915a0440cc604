#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>

namespace rapport {

/// What `rapport info` says of a file: for programs, and in a person's words.
struct Info {
    nlohmann::ordered_json json;
    std::string text; ///< lines, each ended by '\n'
};

Info draft_info(const std::filesystem::path& path);
Info cloth_info(const std::filesystem::path& path);
Info table_info(const std::filesystem::path& path);
Info image_info(const std::filesystem::path& path);
Info model_info(const std::filesystem::path& path);
Info scene_info(const std::filesystem::path& path);

} // namespace rapport
