#include "renderer/app/drawing.h"

#include "renderer/app/lettering.h"
#include "renderer/app/svg.h"
#include "renderer/core/atomic_file.h"
#include "renderer/core/error.h"
#include "renderer/core/input_file.h"
#include "renderer/core/math.h"
#include "renderer/core/png.h"

#include <array>
#include <cmath>

namespace rapport {
namespace {

constexpr Canvas::Colour kWhite{1, 1, 1};
constexpr std::array kAnchors{"start", "middle", "end"};

std::string hex(const Canvas::Colour& colour) {
    const glm::ivec3 c(255.0f * glm::clamp(colour, 0.0f, 1.0f) + 0.5f);
    return fmt::format("#{:02x}{:02x}{:02x}", c.r, c.g, c.b);
}

/// RFC 4648.
std::string base64(const std::string& bytes) {
    constexpr const char* kDigits =
        "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string text;
    for (size_t i = 0; i < bytes.size(); i += 3) {
        uint32_t group = 0;
        for (size_t k = i; k < i + 3; ++k)
            group = group << 8 | (k < bytes.size() ? static_cast<uint8_t>(bytes[k]) : 0u);
        for (size_t digit = 0; digit < 4; ++digit)
            text += i + digit <= bytes.size() ? kDigits[group >> (18 - 6 * digit) & 63] : '=';
    }
    return text;
}

double distance_to_segment(const glm::dvec2& p, const glm::dvec2& a, const glm::dvec2& b) {
    const glm::dvec2 way = b - a;
    const double length2 = glm::dot(way, way);
    const double along = length2 > 0 ? std::clamp(glm::dot(p - a, way) / length2, 0.0, 1.0) : 0.0;
    return glm::distance(p, a + along * way);
}

/// Covers pixels by as much as the band of `width` about the segment does, nearly.
void draw_segment(Canvas& canvas, const glm::dvec2& a, const glm::dvec2& b,
                  const Canvas::Colour& colour, double width) {
    const double reach = 0.5 * width + 0.5;
    const glm::ivec2 low = glm::max(glm::ivec2(glm::floor(glm::min(a, b) - reach)), 0);
    const glm::ivec2 high = glm::min(glm::ivec2(glm::ceil(glm::max(a, b) + reach)),
                                     glm::ivec2(canvas.width(), canvas.height()));
    for (int y = low.y; y < high.y; ++y)
        for (int x = low.x; x < high.x; ++x)
            canvas.blend(x, y, colour,
                         static_cast<float>(reach - distance_to_segment({x + 0.5, y + 0.5}, a, b)));
}

template <class... Visitors> struct Overloaded : Visitors... { using Visitors::operator()...; };

} // namespace

void Drawing::rectangle(const glm::dvec2& low, const glm::dvec2& high, const Colour& colour) {
    shapes_.push_back(Rectangle{low, high, colour});
}

void Drawing::line(std::span<const glm::dvec2> points, const Colour& colour, double width) {
    shapes_.push_back(Line{{points.begin(), points.end()}, colour, width});
}

void Drawing::circle(const glm::dvec2& centre, double radius, const Colour& colour, double width) {
    constexpr int kSides = 96;
    std::vector<glm::dvec2> points;
    for (int i = 0; i <= kSides; ++i)
        points.push_back(centre + radius * glm::dvec2(std::cos(2 * kPi * i / kSides),
                                                      std::sin(2 * kPi * i / kSides)));
    line(points, colour, width);
}

void Drawing::text(const glm::dvec2& at, Anchor anchor, const std::string& words) {
    shapes_.push_back(Text{at, anchor, words});
}

void Drawing::image(const glm::dvec2& at, Canvas pixels) {
    shapes_.push_back(Image{at, std::move(pixels)});
}

std::string Drawing::svg() const {
    Svg svg(size_.x, size_.y);
    const Overloaded add{
        [&](const Rectangle& r) {
            svg.add("<rect x=\"{:g}\" y=\"{:g}\" width=\"{:g}\" height=\"{:g}\" fill=\"{}\"/>\n",
                    r.low.x, r.low.y, r.high.x - r.low.x, r.high.y - r.low.y, hex(r.colour));
        },
        [&](const Line& line) {
            svg.add("<polyline fill=\"none\" stroke=\"{}\" stroke-width=\"{:g}\" points=\"",
                    hex(line.colour), line.width);
            for (const glm::dvec2& p : line.points)
                svg.add("{:.1f},{:.1f} ", p.x, p.y);
            svg.add("\"/>\n");
        },
        [&](const Text& text) {
            svg.text(text.at.x, text.at.y, kAnchors[static_cast<size_t>(text.anchor)], text.words);
        },
        [&](const Image& image) {
            const Canvas& pixels = image.pixels;
            svg.add("<image x=\"{:g}\" y=\"{:g}\" width=\"{}\" height=\"{}\" "
                    "href=\"data:image/png;base64,{}\"/>\n",
                    image.at.x, image.at.y, pixels.width(), pixels.height(),
                    base64(png_file(pixels.bytes(), pixels.width(), pixels.height(), 3)));
        }};
    for (const auto& shape : shapes_)
        std::visit(add, shape);
    return std::move(svg).take();
}

Canvas Drawing::pixels() const {
    const glm::ivec2 size(glm::ceil(size_));
    Canvas canvas(size.x, size.y, kWhite);
    const Overloaded draw{
        [&](const Rectangle& r) {
            canvas.fill(glm::ivec2(glm::round(r.low)), glm::ivec2(glm::round(r.high)), r.colour);
        },
        [&](const Line& line) {
            for (size_t i = 1; i < line.points.size(); ++i)
                draw_segment(canvas, line.points[i - 1], line.points[i], line.colour, line.width);
        },
        [&](const Text& text) {
            const double shift = 0.5 * static_cast<double>(text.anchor) * text_width(text.words);
            draw_text(canvas, text.at.x - shift, text.at.y, text.words);
        },
        [&](const Image& image) {
            const glm::ivec2 corner(glm::round(image.at));
            for (int y = 0; y < image.pixels.height(); ++y)
                for (int x = 0; x < image.pixels.width(); ++x)
                    canvas.set(corner.x + x, corner.y + y, image.pixels.at(x, y));
        }};
    for (const auto& shape : shapes_)
        std::visit(draw, shape);
    return canvas;
}

void Drawing::write(const std::filesystem::path& file) const {
    if (lower_extension(file) == ".svg") {
        const std::string text = svg();
        return write_stream_atomically(file, [&](std::ofstream& stream) { stream << text; });
    }
    const Canvas canvas = pixels();
    write_png_bytes(canvas.bytes(), canvas.width(), canvas.height(), 3, file);
}

} // namespace rapport
