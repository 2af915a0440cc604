#pragma once

#include "materials/table/bsdf_table.h"

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>

namespace rapport {

/// What `rapport info` says of a file: for programs, and in a person's words.
struct Info {
    nlohmann::ordered_json json;
    std::string text; ///< lines, each ended by '\n'
};

/// The four errors of a measurement in words, without a line's end.
std::string error_text(const MeasurementError& error);

Info draft_info(const std::filesystem::path& path);
Info cloth_info(const std::filesystem::path& path);
/// A table of ours, or a `measured` reflectance.
Info table_info(const std::filesystem::path& path);
Info image_info(const std::filesystem::path& path);
Info model_info(const std::filesystem::path& path);
Info scene_info(const std::filesystem::path& path);

} // namespace rapport
