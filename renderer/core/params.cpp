#include "renderer/core/params.h"

#include "renderer/core/error.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <limits>

namespace rapport {
namespace {

std::string place_of(int line, int column) {
    if (line <= 0)
        return "";
    return column > 0 ? fmt::format("{}:{}", line, column) : std::to_string(line);
}

std::string declaration(const Param& param) {
    return fmt::format("\"{} {}\"", param.type, param.name);
}

size_t value_count(const Param& param) {
    return std::max(param.numbers.size(), param.strings.size());
}

std::string plural(size_t count) { return fmt::format("{} value{}", count, count == 1 ? "" : "s"); }

const std::initializer_list<std::string_view> kPoint2Types{"point2", "vector2"};
const std::initializer_list<std::string_view> kPoint3Types{"point3", "point",  "vector3",
                                                           "vector", "normal", "normal3"};

} // namespace

Params::Params(std::string path, std::string owner, int line, int column)
    : path_(std::move(path)), owner_(std::move(owner)), line_(line), column_(column) {}

std::string Params::place() const { return place_of(line_, column_); }

void Params::add(Param param) {
    if (const Param* first = find(param.name))
        throw FileError(
            path_, place_of(param.line, param.column),
            fmt::format("\"{}\" once in {}", param.name, owner_),
            fmt::format("a second one, after that at {}", place_of(first->line, first->column)));
    params_.push_back(std::move(param));
}

bool Params::has(std::string_view name) const {
    asked_.emplace(name);
    return find(name) != nullptr;
}

bool Params::is_string(std::string_view name) const {
    const Param* param = find(name);
    return param && param->type == "string";
}

std::optional<std::string> Params::take_texture(std::string_view name) {
    const Param* param = find(name);
    if (!param || param->type != "texture")
        return std::nullopt;
    const std::string texture = find_typed(name, {"texture"}, 1)->strings[0];
    params_.erase(params_.begin() + (param - params_.data()));
    return texture;
}

const Param* Params::find(std::string_view name) const {
    const auto found = std::ranges::find(params_, name, &Param::name);
    return found == params_.end() ? nullptr : &*found;
}

/// The parameter, checked to be of one of the types and to have `count` values (0 = any number),
/// all of them finite as float; nullptr if it is not given.
const Param* Params::find_typed(std::string_view name,
                                std::initializer_list<std::string_view> types, size_t count) const {
    asked_.emplace(name);
    const Param* param = find(name);
    if (!param)
        return nullptr;
    if (std::ranges::find(types, param->type) == types.end())
        fail(name, fmt::format("\"{}\" of type {}", name, fmt::join(types, " or ")),
             declaration(*param));
    if (count > 0 && value_count(*param) != count)
        fail(name, fmt::format("{} for {}", plural(count), declaration(*param)),
             plural(value_count(*param)));
    for (const double number : param->numbers)
        if (!(std::abs(number) <= std::numeric_limits<float>::max()))
            fail(name, "finite numbers for " + declaration(*param), fmt::format("{}", number));
    return param;
}

float Params::get_float(std::string_view name, float fallback) const {
    const Param* param = find_typed(name, {"float"}, 1);
    return param ? static_cast<float>(param->numbers[0]) : fallback;
}

int Params::get_int(std::string_view name, int fallback) const {
    return find_typed(name, {"integer"}, 1) ? get_ints(name)[0] : fallback;
}

bool Params::get_bool(std::string_view name, bool fallback) const {
    const Param* param = find_typed(name, {"bool"}, 1);
    return param ? param->numbers[0] != 0 : fallback;
}

std::string Params::get_string(std::string_view name, std::string_view fallback) const {
    const Param* param = find_typed(name, {"string"}, 1);
    return param ? param->strings[0] : std::string(fallback);
}

Rgb Params::get_rgb(std::string_view name, const Rgb& fallback) const {
    const Param* param = find_typed(name, {"rgb", "float"}, 0);
    if (!param)
        return fallback;
    if (param->type == "rgb") {
        find_typed(name, {"rgb"}, 3);
        return {param->numbers[0], param->numbers[1], param->numbers[2]};
    }
    find_typed(name, {"float"}, 1);
    return Rgb(static_cast<float>(param->numbers[0]));
}

glm::vec3 Params::get_point(std::string_view name, const glm::vec3& fallback) const {
    const Param* param = find_typed(name, kPoint3Types, 3);
    return param ? glm::vec3(param->numbers[0], param->numbers[1], param->numbers[2]) : fallback;
}

std::vector<float> Params::get_floats(std::string_view name) const {
    const Param* param = find_typed(name, {"float"}, 0);
    return param ? std::vector<float>(param->numbers.begin(), param->numbers.end())
                 : std::vector<float>();
}

std::vector<int> Params::get_ints(std::string_view name) const {
    const Param* param = find_typed(name, {"integer"}, 0);
    std::vector<int> values;
    if (!param)
        return values;
    for (const double number : param->numbers) {
        if (number != std::floor(number) || number < std::numeric_limits<int>::min() ||
            number > std::numeric_limits<int>::max())
            fail(name, "whole numbers of 32 bits for " + declaration(*param),
                 fmt::format("{}", number));
        values.push_back(static_cast<int>(number));
    }
    return values;
}

std::vector<glm::vec2> Params::get_point2s(std::string_view name) const {
    const Param* param = find_typed(name, kPoint2Types, 0);
    std::vector<glm::vec2> points;
    if (!param)
        return points;
    if (param->numbers.size() % 2 != 0)
        fail(name, "pairs of numbers for " + declaration(*param), plural(param->numbers.size()));
    for (size_t i = 0; i < param->numbers.size(); i += 2)
        points.emplace_back(param->numbers[i], param->numbers[i + 1]);
    return points;
}

std::vector<glm::vec3> Params::get_point3s(std::string_view name) const {
    const Param* param = find_typed(name, kPoint3Types, 0);
    std::vector<glm::vec3> points;
    if (!param)
        return points;
    if (param->numbers.size() % 3 != 0)
        fail(name, "triples of numbers for " + declaration(*param), plural(param->numbers.size()));
    for (size_t i = 0; i < param->numbers.size(); i += 3)
        points.emplace_back(param->numbers[i], param->numbers[i + 1], param->numbers[i + 2]);
    return points;
}

void Params::check_all_used() const {
    for (const Param& param : params_)
        if (!asked_.contains(param.name))
            fail(param.name,
                 asked_.empty()
                     ? fmt::format("no parameters for {}", owner_)
                     : fmt::format("a parameter of {} ({})", owner_, fmt::join(asked_, ", ")),
                 declaration(param));
}

void Params::fail(std::string_view name, const std::string& expected,
                  const std::string& found) const {
    const Param* param = find(name);
    throw FileError(path_, param ? place_of(param->line, param->column) : place(), expected, found);
}

} // namespace rapport
