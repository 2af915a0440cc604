#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <vector>

namespace rapport {

/// What a glTF's JSON says, after checking it: nesting, the version, the kinds of all values that
/// the geometry depends on, and the required extensions. FileError says where it is wrong; required
/// extensions that do not touch the geometry become warnings.
nlohmann::json read_gltf_json(std::string_view text, const std::string& path,
                              std::vector<std::string>& warnings);

} // namespace rapport
