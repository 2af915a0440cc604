#include "renderer/scene/pbrt/pbrt_lexer.h"

#include "renderer/core/input_file.h"

#include <charconv>
#include <cmath>
#include <fmt/format.h>
#include <iterator>

namespace rapport {
namespace {

std::string read_text(const std::filesystem::path& file) {
    InputFile input = open_input(file);
    return {std::istreambuf_iterator<char>(input.stream), {}};
}

bool is_letter(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_'; }
bool is_digit(char c) { return c >= '0' && c <= '9'; }
bool starts_number(char c) { return is_digit(c) || c == '-' || c == '+' || c == '.'; }

std::string shown(char c) {
    return c >= ' ' && c <= '~' ? fmt::format("'{}'", c)
                                : fmt::format("byte 0x{:02x}", static_cast<unsigned char>(c));
}

} // namespace

PbrtLexer::PbrtLexer(const std::filesystem::path& file)
    : path_(file.string()), text_(read_text(file)), token_(scan()) {}

PbrtToken PbrtLexer::next() {
    PbrtToken token = std::move(token_);
    token_ = scan();
    return token;
}

FileError PbrtLexer::error(const PbrtToken& token, const std::string& expected) const {
    switch (token.kind) {
    case PbrtToken::Kind::end:
        return error(token, expected, "the end of the file");
    case PbrtToken::Kind::string:
        return error(token, expected, '"' + token.text + '"');
    default:
        return error(token, expected, token.text);
    }
}

FileError PbrtLexer::error(const PbrtToken& token, const std::string& expected,
                           const std::string& found) const {
    return FileError(path_, fmt::format("{}:{}", token.line, token.column), expected, found);
}

char PbrtLexer::take() {
    const char c = text_[position_++];
    if (c == '\n') {
        ++line_;
        column_ = 1;
    } else {
        ++column_;
    }
    return c;
}

void PbrtLexer::skip_blanks() {
    bool comment = false;
    while (!at_end()) {
        const char c = text_[position_];
        if (c == '#')
            comment = true;
        else if (c == '\n')
            comment = false;
        else if (!comment && c != ' ' && c != '\t' && c != '\r')
            return;
        take();
    }
}

PbrtToken PbrtLexer::scan() {
    skip_blanks();
    PbrtToken token;
    token.line = line_;
    token.column = column_;
    if (at_end())
        return token;
    const char c = text_[position_];
    if (c == '"') {
        scan_string(token);
    } else if (c == '[' || c == ']') {
        token.kind = c == '[' ? PbrtToken::Kind::open : PbrtToken::Kind::close;
        token.text = take();
    } else if (is_letter(c)) {
        token.kind = PbrtToken::Kind::identifier;
        while (!at_end() && (is_letter(text_[position_]) || is_digit(text_[position_])))
            token.text += take();
    } else if (starts_number(c)) {
        scan_number(token);
    } else {
        throw error(token, "a directive, a \"string\", a number, '[' or ']'", shown(c));
    }
    return token;
}

void PbrtLexer::scan_string(PbrtToken& token) {
    token.kind = PbrtToken::Kind::string;
    take();
    for (;;) {
        if (at_end() || text_[position_] == '\n')
            throw error(token, "a string closed by '\"' on the same line",
                        at_end() ? "the end of the file" : "the end of the line");
        char c = take();
        if (c == '"')
            return;
        if (c == '\\' && !at_end()) {
            static constexpr std::string_view kEscapes = "bfnrt\\'\"", kMeant = "\b\f\n\r\t\\'\"";
            const char escape = take();
            const size_t which = kEscapes.find(escape);
            if (which == std::string_view::npos)
                throw error(token, "one of the escapes \\b \\f \\n \\r \\t \\\\ \\' \\\"",
                            "\\ before " + shown(escape));
            c = kMeant[which];
        }
        token.text += c;
    }
}

void PbrtLexer::scan_number(PbrtToken& token) {
    token.kind = PbrtToken::Kind::number;
    while (!at_end() && (starts_number(text_[position_]) || is_letter(text_[position_])))
        token.text += take();
    const char* first = token.text.data() + (token.text.front() == '+');
    const char* last = token.text.data() + token.text.size();
    const auto [end, status] = std::from_chars(first, last, token.number);
    if (status != std::errc{} || end != last || !std::isfinite(token.number))
        throw error(token, "a finite number", token.text);
}

} // namespace rapport
