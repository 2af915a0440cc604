#include "renderer/scene/gltf/gltf_json.h"

#include "renderer/core/error.h"

#include <algorithm>
#include <array>
#include <fmt/format.h>

namespace rapport {
namespace {

using Json = nlohmann::json;

/// Deeper nesting than any glTF has; a parser that calls itself would run out of stack.
constexpr int kMaxDepth = 64;

constexpr std::array<std::string_view, 22> kIndices = {
    "buffer",   "bufferView",    "byteLength", "byteOffset", "byteStride",
    "count",    "componentType", "index",      "indices",    "inverseBindMatrices",
    "material", "mesh",          "mode",       "sampler",    "scene",
    "skeleton", "skin",          "source",     "texCoord",   "wrapS",
    "wrapT",    "magFilter"};
constexpr std::array<std::string_view, 3> kIndexLists = {"children", "joints", "nodes"};
/// Lists of numbers, by the section they stand in, and how long they are; 0 = any length.
struct NumberList {
    std::string_view section, name;
    size_t length;
};
constexpr std::array<NumberList, 7> kNumberLists = {{{"nodes", "matrix", 16},
                                                     {"nodes", "rotation", 4},
                                                     {"nodes", "scale", 3},
                                                     {"nodes", "translation", 3},
                                                     {"nodes", "weights", 0},
                                                     {"meshes", "weights", 0},
                                                     {"materials", "baseColorFactor", 4}}};

/// Geometry that is stored in a form which tinygltf does not decode.
constexpr std::array<std::string_view, 3> kCompressions = {
    "KHR_draco_mesh_compression", "EXT_meshopt_compression", "KHR_meshopt_compression"};
/// Extensions that are honoured, and beginnings of the names of those that only dress the surface.
constexpr std::array<std::string_view, 2> kKnown = {"KHR_texture_transform",
                                                    "KHR_mesh_quantization"};
constexpr std::array<std::string_view, 7> kDressings = {
    "KHR_materials_",        "KHR_texture_basisu",  "EXT_texture_",
    "MSFT_texture_dds",      "KHR_lights_punctual", "KHR_xmp",
    "EXT_lights_image_based"};

template <class Array> bool contains(const Array& names, std::string_view name) {
    return std::find(names.begin(), names.end(), name) != names.end();
}

class Checker {
  public:
    Checker(const std::string& path, std::vector<std::string>& warnings)
        : path_(path), warnings_(warnings) {}

    Json run(std::string_view text) {
        Json root = parse(text);
        if (!root.is_object())
            fail("", "a JSON object", root);
        const Json asset = root.value("asset", Json());
        if (!asset.is_object() || !asset.contains("version"))
            throw FileError(path_, "asset.version", "\"2.0\"", "none");
        if (!asset["version"].is_string() || !asset["version"].get<std::string>().starts_with("2."))
            fail("asset.version", "\"2.0\"", asset["version"]);
        if (asset.contains("minVersion") && asset["minVersion"] != "2.0")
            fail("asset.minVersion", "\"2.0\"", asset["minVersion"]);
        check_required_extensions(root);
        for (const char* section :
             {"scenes", "nodes", "meshes", "skins", "accessors", "bufferViews", "buffers",
              "materials", "textures", "samplers", "images"}) {
            if (!root.contains(section))
                continue;
            if (!root[section].is_array())
                fail(section, "an array", root[section]);
            for (size_t i = 0; i < root[section].size(); ++i)
                check_object(root[section][i], fmt::format("{}[{}]", section, i));
        }
        if (root.contains("scene"))
            check_index(root["scene"], "scene");
        return root;
    }

  private:
    [[noreturn]] void fail(const std::string& place, const std::string& expected,
                           const Json& found) const {
        std::string text = found.is_structured() ? std::string(found.type_name()) : found.dump();
        if (text.size() > 40)
            text = text.substr(0, 40) + "…";
        throw FileError(path_, place, expected, text);
    }

    Json parse(std::string_view text) const {
        try {
            return Json::parse(text, [&](int depth, Json::parse_event_t, Json&) {
                if (depth > kMaxDepth)
                    throw FileError(path_, "", fmt::format("JSON at most {} deep", kMaxDepth),
                                    "deeper nesting");
                return true;
            });
        } catch (const Json::parse_error& error) {
            // "[json.exception.parse_error.101] parse error at line 1, column 2: …"
            const std::string what = error.what();
            throw FileError(path_, fmt::format("byte {}", error.byte), "JSON",
                            what.substr(what.find("] ") + 2));
        } catch (const Json::out_of_range& error) { // a number that no double can hold
            const std::string what = error.what();
            throw FileError(path_, "", "JSON", what.substr(what.find("] ") + 2));
        }
    }

    void check_index(const Json& value, const std::string& place) const {
        constexpr uint64_t kLargest = uint64_t{1} << 53;
        if (!value.is_number_unsigned() || value.get<uint64_t>() > kLargest)
            fail(place, "a non-negative integer", value);
        const bool is_size = place.find(".sparse.") == std::string::npos &&
                             (place.ends_with("byteLength") || place.ends_with("byteOffset") ||
                              place.ends_with("count"));
        if (!is_size && value.get<uint64_t>() > std::numeric_limits<int32_t>::max())
            fail(place, "a number below 2³¹", value); // tinygltf keeps these as int
    }

    void check_object(const Json& object, const std::string& place) const {
        if (!object.is_object())
            fail(place, "an object", object);
        for (const auto& [key, value] : object.items()) {
            const std::string inner = place + "." + key;
            if (key == "extras" || key == "extensions")
                continue;
            if (key == "attributes") {
                check_accessors(value, inner);
            } else if (key == "targets" && value.is_array()) {
                for (size_t i = 0; i < value.size(); ++i)
                    check_accessors(value[i], fmt::format("{}[{}]", inner, i));
            } else if (contains(kIndexLists, key)) {
                if (!value.is_array())
                    fail(inner, "an array", value);
                for (size_t i = 0; i < value.size(); ++i)
                    check_index(value[i], fmt::format("{}[{}]", inner, i));
            } else if (contains(kIndices, key) && !value.is_object()) {
                check_index(value, inner);
            } else if (key == "normalized") {
                if (!value.is_boolean())
                    fail(inner, "true or false", value);
            } else if (value.is_object()) {
                check_object(value, inner);
            } else if (key == "primitives") {
                for (size_t i = 0; value.is_array() && i < value.size(); ++i)
                    check_object(value[i], fmt::format("{}[{}]", inner, i));
            } else {
                for (const NumberList& list : kNumberLists)
                    if (key == list.name && place.starts_with(list.section))
                        check_numbers(value, list.length, inner);
            }
        }
    }

    void check_accessors(const Json& attributes, const std::string& place) const {
        if (!attributes.is_object())
            fail(place, "an object", attributes);
        for (const auto& [name, accessor] : attributes.items())
            check_index(accessor, place + "." + name);
    }

    void check_numbers(const Json& list, size_t length, const std::string& place) const {
        const std::string expected =
            length > 0 ? fmt::format("an array of {} numbers", length) : "an array of numbers";
        if (!list.is_array())
            fail(place, expected, list);
        if (length > 0 && list.size() != length)
            throw FileError(path_, place, expected, fmt::format("{}", list.size()));
        for (const Json& number : list)
            if (!number.is_number())
                fail(place, expected, number);
    }

    void check_required_extensions(const Json& root) const {
        const Json required = root.value("extensionsRequired", Json::array());
        if (!required.is_array())
            fail("extensionsRequired", "an array", required);
        for (const Json& entry : required) {
            if (!entry.is_string())
                fail("extensionsRequired", "names", entry);
            const std::string name = entry;
            if (contains(kKnown, name))
                continue;
            if (contains(kCompressions, name))
                throw FileError(path_, "extensionsRequired", "uncompressed geometry",
                                "not supported: " + name);
            if (std::none_of(kDressings.begin(), kDressings.end(),
                             [&](std::string_view start) { return name.starts_with(start); }))
                throw FileError(path_, "extensionsRequired", "extensions that are known here",
                                "not supported: " + name);
            warnings_.push_back(
                fmt::format("extension {} ignored: only geometry and base colour are read", name));
        }
    }

    const std::string& path_;
    std::vector<std::string>& warnings_;
};

} // namespace

nlohmann::json read_gltf_json(std::string_view text, const std::string& path,
                              std::vector<std::string>& warnings) {
    return Checker(path, warnings).run(text);
}

} // namespace rapport
