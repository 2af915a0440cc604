#include "renderer/scene/pbrt/pbrt_params.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <limits>

namespace rapport {
namespace {

using Kind = PbrtToken::Kind;

constexpr std::array kTypes{"bool",    "float",  "integer", "normal", "normal3",
                            "point",   "point2", "point3",  "rgb",    "string",
                            "texture", "vector", "vector2", "vector3"};

bool fits_integer(double number) {
    return number == std::floor(number) && number >= std::numeric_limits<int32_t>::min() &&
           number <= std::numeric_limits<int32_t>::max();
}

Param read_declaration(PbrtLexer& lexer) {
    const PbrtToken declaration = lexer.next();
    const std::string& text = declaration.text;
    Param param;
    param.line = declaration.line;
    param.column = declaration.column;
    const size_t blank = text.find_first_of(" \t");
    const size_t name = text.find_first_not_of(" \t", blank);
    if (blank == 0 || blank == std::string::npos || name == std::string::npos ||
        text.find_first_of(" \t", name) != std::string::npos)
        throw lexer.error(declaration, "a parameter as \"type name\"");
    param.type = text.substr(0, blank);
    param.name = text.substr(name);
    if (std::ranges::find(kTypes, param.type) == kTypes.end())
        throw lexer.error(declaration, fmt::format("one of the types {}", fmt::join(kTypes, ", ")));
    return param;
}

void read_value(PbrtLexer& lexer, Param& param) {
    const PbrtToken& token = lexer.peek();
    if (param.type == "string" || param.type == "texture") {
        if (token.kind != Kind::string)
            throw lexer.error(token, "a \"string\"");
        param.strings.push_back(token.text);
    } else if (param.type == "bool") {
        if (token.kind != Kind::identifier || (token.text != "true" && token.text != "false"))
            throw lexer.error(token, "true or false");
        param.numbers.push_back(token.text == "true");
    } else {
        if (token.kind != Kind::number)
            throw lexer.error(token, "a number");
        if (param.type == "integer" && !fits_integer(token.number))
            throw lexer.error(token, "a whole number of 32 bits");
        param.numbers.push_back(token.number);
    }
    lexer.next();
}

} // namespace

Params read_pbrt_params(PbrtLexer& lexer, const std::string& owner, const PbrtToken& place) {
    Params params(lexer.path(), owner, place.line, place.column);
    while (lexer.peek().kind == Kind::string) {
        Param param = read_declaration(lexer);
        if (lexer.peek().kind == Kind::open) {
            lexer.next();
            while (lexer.peek().kind != Kind::close)
                read_value(lexer, param);
            lexer.next();
        } else {
            read_value(lexer, param);
        }
        params.add(std::move(param));
    }
    return params;
}

} // namespace rapport
