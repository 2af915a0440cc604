#pragma once

#include "renderer/app/canvas.h"

#include <filesystem>
#include <span>
#include <string>
#include <variant>

namespace rapport {

/// A picture of shapes on a white ground, the later ones above, that becomes an SVG or a PNG.
/// Lengths are in pixels, (0, 0) at the top left, y down.
class Drawing {
  public:
    using Colour = Canvas::Colour;
    enum class Anchor { start, middle, end };

    Drawing(double width, double height) : size_(width, height) {}

    void rectangle(const glm::dvec2& low, const glm::dvec2& high, const Colour& colour);
    void line(std::span<const glm::dvec2> points, const Colour& colour, double width);
    void circle(const glm::dvec2& centre, double radius, const Colour& colour, double width);
    /// One line of text, `at` on its base line.
    void text(const glm::dvec2& at, Anchor anchor, const std::string& words);
    /// Pixels, one to one, their corner at `at`.
    void image(const glm::dvec2& at, Canvas pixels);

    /// Writes it whole, as the file's ending says: .svg or .png.
    void write(const std::filesystem::path& file) const;
    std::string svg() const;
    Canvas pixels() const;

  private:
    struct Rectangle {
        glm::dvec2 low, high;
        Colour colour;
    };
    struct Line {
        std::vector<glm::dvec2> points;
        Colour colour;
        double width;
    };
    struct Text {
        glm::dvec2 at;
        Anchor anchor;
        std::string words;
    };
    struct Image {
        glm::dvec2 at;
        Canvas pixels;
    };

    glm::dvec2 size_;
    std::vector<std::variant<Rectangle, Line, Text, Image>> shapes_;
};

} // namespace rapport
