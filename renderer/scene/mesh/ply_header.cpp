#include "renderer/scene/mesh/ply_header.h"

#include "renderer/core/error.h"

#include <algorithm>
#include <charconv>
#include <fmt/format.h>
#include <map>

namespace rapport {
namespace {

const std::map<std::string_view, PlyType> kTypes = {
    {"char", PlyType::int8},      {"int8", PlyType::int8},       {"uchar", PlyType::uint8},
    {"uint8", PlyType::uint8},    {"short", PlyType::int16},     {"int16", PlyType::int16},
    {"ushort", PlyType::uint16},  {"uint16", PlyType::uint16},   {"int", PlyType::int32},
    {"int32", PlyType::int32},    {"uint", PlyType::uint32},     {"uint32", PlyType::uint32},
    {"float", PlyType::float32},  {"float32", PlyType::float32}, {"double", PlyType::float64},
    {"float64", PlyType::float64}};

const std::map<std::string_view, PlyFormat> kFormats = {
    {"ascii", PlyFormat::ascii},
    {"binary_little_endian", PlyFormat::binary_little_endian},
    {"binary_big_endian", PlyFormat::binary_big_endian}};

std::vector<std::string_view> words(std::string_view line) {
    std::vector<std::string_view> result;
    constexpr std::string_view blanks = " \t\r";
    for (size_t begin = line.find_first_not_of(blanks); begin != std::string_view::npos;) {
        const size_t end = std::min(line.find_first_of(blanks, begin), line.size());
        result.push_back(line.substr(begin, end - begin));
        begin = line.find_first_not_of(blanks, end);
    }
    return result;
}

/// The header, line by line.
class HeaderParser {
  public:
    HeaderParser(std::string_view file, std::string path) : file_(file), path_(std::move(path)) {}

    PlyHeader run() {
        next_line();
        if (words_.size() != 1 || words_[0] != "ply")
            fail("'ply'");
        next_line();
        if (words_.size() != 3 || words_[0] != "format" || !kFormats.contains(words_[1]) ||
            words_[2] != "1.0")
            fail("'format ascii|binary_little_endian|binary_big_endian 1.0'");
        PlyHeader header{kFormats.at(words_[1]), {}, 0, 0};
        for (next_line(); words_.empty() || words_[0] != "end_header"; next_line()) {
            if (words_.empty() || words_[0] == "comment" || words_[0] == "obj_info")
                continue;
            if (words_[0] == "element")
                header.elements.push_back(element());
            else if (words_[0] == "property" && !header.elements.empty())
                header.elements.back().properties.push_back(property());
            else
                fail("'element', 'property', 'comment' or 'end_header'");
        }
        header.data_offset = offset_;
        header.data_line = line_ + 1;
        return header;
    }

  private:
    [[noreturn]] void fail(const std::string& expected) const {
        throw FileError(path_, line_, expected, fmt::format("'{}'", text_.substr(0, 40)));
    }

    void next_line() {
        ++line_;
        const size_t end = file_.find('\n', offset_);
        if (end == std::string_view::npos)
            throw FileError(path_, line_, "'end_header'", "the end of the file");
        text_ = file_.substr(offset_, end - offset_);
        offset_ = end + 1;
        words_ = words(text_);
    }

    PlyElement element() const {
        PlyElement result;
        if (words_.size() != 3)
            fail("'element NAME COUNT'");
        result.name = words_[1];
        const char* end = words_[2].data() + words_[2].size();
        const auto [stop, error] = std::from_chars(words_[2].data(), end, result.count);
        if (error != std::errc() || stop != end)
            fail("a number of elements");
        return result;
    }

    PlyType type(std::string_view word) const {
        const auto found = kTypes.find(word);
        if (found == kTypes.end())
            fail("a type from char to double");
        return found->second;
    }

    PlyProperty property() const {
        if (words_.size() == 3)
            return {std::string(words_[2]), type(words_[1]), {}};
        if (words_.size() != 5 || words_[1] != "list")
            fail("'property TYPE NAME' or 'property list TYPE TYPE NAME'");
        const PlyType list_size = type(words_[2]);
        if (list_size == PlyType::float32 || list_size == PlyType::float64)
            fail("an integer type for the length of a list");
        return {std::string(words_[4]), type(words_[3]), list_size};
    }

    std::string_view file_;
    std::string path_;
    size_t offset_ = 0;
    int line_ = 0;
    std::string_view text_;
    std::vector<std::string_view> words_;
};

} // namespace

size_t size_of(PlyType type) {
    constexpr size_t kSizes[] = {1, 1, 2, 2, 4, 4, 4, 8};
    return kSizes[static_cast<size_t>(type)];
}

PlyHeader parse_ply_header(std::string_view file, const std::filesystem::path& path) {
    return HeaderParser(file, path.string()).run();
}

} // namespace rapport
