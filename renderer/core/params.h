#pragma once

#include "renderer/core/bands.h"

#include <glm/glm.hpp>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

namespace rapport {

/// One `"type name" [values]` of a scene file.
struct Param {
    std::string type; ///< as written: float, integer, bool, string, rgb, point3, normal, …
    std::string name;
    std::vector<double> numbers;      ///< all numeric types, and bool as 0 or 1
    std::vector<std::string> strings; ///< string and texture names
    int line = 0, column = 0;
};

/// The typed parameters of one directive. Every getter notes the name it was asked for, so that
/// `check_all_used` can refuse what nobody reads and list what would have been read. A value of
/// the wrong type or count is a FileError at its place.
class Params {
  public:
    Params() = default;
    /// `path` is the file the parameters stand in, `owner` what they belong to ("Shape \"gltf\""),
    /// line and column the place of that, where it has one.
    Params(std::string path, std::string owner, int line, int column = 0);

    /// A second parameter of the same name is a FileError.
    void add(Param param);
    bool has(std::string_view name) const;
    /// Whether the parameter is given and of type "string".
    bool is_string(std::string_view name) const;
    /// Takes out the parameter `name` if it is of type "texture", and returns the texture's name.
    std::optional<std::string> take_texture(std::string_view name);

    float get_float(std::string_view name, float fallback) const;
    int get_int(std::string_view name, int fallback) const;
    bool get_bool(std::string_view name, bool fallback) const;
    std::string get_string(std::string_view name, std::string_view fallback) const;
    /// "rgb", or a "float" taken as grey.
    Rgb get_rgb(std::string_view name, const Rgb& fallback) const;
    glm::vec3 get_point(std::string_view name, const glm::vec3& fallback) const;
    std::vector<float> get_floats(std::string_view name) const;
    std::vector<int> get_ints(std::string_view name) const;
    std::vector<glm::vec2> get_point2s(std::string_view name) const;
    std::vector<glm::vec3> get_point3s(std::string_view name) const; ///< point, vector or normal

    /// FileError for the first parameter that no getter asked for; lists those that were.
    void check_all_used() const;
    /// FileError at the parameter `name` (or at the directive, if absent), for a bad value.
    [[noreturn]] void fail(std::string_view name, const std::string& expected,
                           const std::string& found) const;

    const std::string& path() const { return path_; }
    const std::string& owner() const { return owner_; }
    int line() const { return line_; }
    std::string place() const; ///< of the owner; see FileError

  private:
    const Param* find(std::string_view name) const;
    const Param* find_typed(std::string_view name, std::initializer_list<std::string_view> types,
                            size_t count) const;

    std::string path_, owner_;
    int line_ = 0, column_ = 0;
    std::vector<Param> params_;
    mutable std::set<std::string, std::less<>> asked_;
};

} // namespace rapport
