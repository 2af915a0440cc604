#pragma once

#include <fmt/format.h>
#include <iterator>
#include <string>

namespace rapport {

/// The text of an SVG picture in the making, on a white ground; lengths in pixels, y down.
class Svg {
  public:
    Svg(double width, double height) {
        add("<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{0}\" height=\"{1}\" "
            "viewBox=\"0 0 {0} {1}\" font-family=\"sans-serif\" font-size=\"12\">\n"
            "<rect width=\"100%\" height=\"100%\" fill=\"white\"/>\n",
            width, height);
    }

    template <class... Arguments>
    void add(fmt::format_string<Arguments...> format, Arguments&&... arguments) {
        fmt::format_to(std::back_inserter(text_), format, std::forward<Arguments>(arguments)...);
    }
    /// `anchor` is SVG's: start, middle or end.
    void text(double x, double y, const char* anchor, const std::string& words,
              const char* more = "") {
        add("<text x=\"{:.1f}\" y=\"{:.1f}\" text-anchor=\"{}\"{}>{}</text>\n", x, y, anchor, more,
            escaped(words));
    }
    void line(double x1, double y1, double x2, double y2, const std::string& style) {
        add("<line x1=\"{:.1f}\" y1=\"{:.1f}\" x2=\"{:.1f}\" y2=\"{:.1f}\" {}/>\n", x1, y1, x2, y2,
            style);
    }
    /// The whole of it.
    std::string take() && { return std::move(text_) + "</svg>\n"; }

  private:
    static std::string escaped(const std::string& text) {
        std::string escaped;
        for (const char c : text) {
            if (c == '&')
                escaped += "&amp;";
            else if (c == '<')
                escaped += "&lt;";
            else
                escaped += c;
        }
        return escaped;
    }

    std::string text_;
};

} // namespace rapport
