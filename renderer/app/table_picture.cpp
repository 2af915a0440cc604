#include "renderer/app/table_picture.h"

#include "renderer/core/parallel.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <fmt/format.h>

namespace rapport {
namespace {

constexpr std::array kTheta{0.0, 30.0, 60.0};
constexpr int kDisc = 230, kGap = 36, kTitle = 38, kKey = 18; ///< pixels
constexpr int kPolar = 400;                                   ///< diameter
constexpr double kWidth = 4 * (kDisc + kGap) + kGap;
constexpr Drawing::Colour kWhite{1, 1, 1}, kGrid{0.82f, 0.82f, 0.84f}, kAxis{0.55f, 0.55f, 0.58f};

/// Told apart by people who see colours differently (Okabe & Ito 2008).
constexpr std::array<Drawing::Colour, 3> kColours{
    {{0.0f, 0.45f, 0.70f}, {0.84f, 0.37f, 0.0f}, {0.0f, 0.62f, 0.45f}}};

glm::dvec3 direction_of(const IncidentDirection& from) {
    return spherical_direction(from.theta, from.phi);
}

/// The measured direction nearest to one, of the front side where it was measured there at all.
size_t nearest_direction(const BsdfTable& table, const glm::dvec3& wanted) {
    const auto distance = [&](size_t d) {
        const IncidentDirection& from = table.incident[d];
        return glm::distance(direction_of(from), wanted) + (from.side == Side::front ? 0 : 10);
    };
    size_t nearest = 0;
    for (size_t d = 1; d < table.directions(); ++d)
        if (distance(d) < distance(nearest))
            nearest = d;
    return nearest;
}

std::string name_of(const IncidentDirection& from) {
    return fmt::format("{}θ = {:.0f}°{}", from.side == Side::front ? "" : "back, ",
                       degrees(from.theta),
                       from.theta > 0 ? fmt::format(", φ = {:.0f}°", degrees(from.phi)) : "");
}

/// Calls colour(direction) for each pixel of a disc: the normal in the middle, weft to the right,
/// warp upwards, sinθ outwards.
template <class Colour> Canvas disc(const Colour& colour) {
    Canvas canvas(kDisc, kDisc, kWhite);
    parallel_for(kDisc, [&](size_t row) {
        const int y = static_cast<int>(row);
        for (int x = 0; x < kDisc; ++x) {
            const glm::dvec2 p(2 * (x + 0.5) / kDisc - 1, 1 - 2 * (y + 0.5) / kDisc);
            if (glm::length(p) < 1)
                canvas.set(x, y, colour(glm::dvec3(p, std::sqrt(1 - glm::dot(p, p)))));
        }
    });
    return canvas;
}

/// Brightest white, in the square root; where the light comes from, a white dot.
Canvas hemisphere(const BsdfTable& table, size_t direction, int block) {
    const ExitBins exits = table.exits_of(direction);
    const size_t bands = table.bands.count();
    double brightest = 1e-30;
    for (size_t bin = 0; bin < table.exits.bins(); ++bin)
        for (size_t band = 0; band < bands; ++band)
            brightest = std::max<double>(brightest, table.at(direction, block, bin, band));
    const glm::dvec3 light = direction_of(table.incident[direction]);
    return disc([&](const glm::dvec3& to) {
        if (glm::distance(glm::dvec2(to), glm::dvec2(light)) < 0.025)
            return kWhite;
        const size_t bin = exits.bin(to);
        Drawing::Colour colour;
        for (size_t c = 0; c < 3; ++c) {
            const size_t band = bands == 3 ? c : bands / 2; // RGB, else the middle band in grey
            const double value = table.at(direction, block, bin, band) / brightest;
            colour[static_cast<int>(c)] = static_cast<float>(std::sqrt(value));
        }
        return colour;
    });
}

/// From pale to dark with growing ε.
Drawing::Colour error_colour(double share) {
    const auto s = static_cast<float>(share);
    const Drawing::Colour pale{1.0f, 0.95f, 0.75f}, middle{0.90f, 0.45f, 0.15f},
        dark{0.35f, 0.03f, 0.15f};
    return s < 0.5f ? glm::mix(pale, middle, 2 * s) : glm::mix(middle, dark, 2 * s - 1);
}

struct ErrorScale {
    double least, most;

    Drawing::Colour colour(double error) const {
        return error_colour(most > least ? (error - least) / (most - least) : 0.5);
    }
};

/// ε of the measured direction that is nearest to each.
Canvas error_map(const BsdfTable& table, const std::vector<size_t>& directions,
                 const ErrorScale& scale) {
    std::vector<glm::dvec3> from;
    for (const size_t d : directions)
        from.push_back(direction_of(table.incident[d]));
    return disc([&](const glm::dvec3& to) {
        const auto distance = [&](const glm::dvec3& other) { return glm::distance(to, other); };
        const size_t nearest =
            static_cast<size_t>(std::ranges::min_element(from, {}, distance) - from.begin());
        return scale.colour(table.accuracy[directions[nearest]]);
    });
}

/// A disc() with its title above, and the directions of weft and warp at its edge.
void draw_disc(Drawing& drawing, const glm::dvec2& corner, const std::string& title,
               Canvas pixels) {
    const double middle = kDisc / 2.0;
    drawing.text(corner + glm::dvec2(middle, 16 - kTitle), Drawing::Anchor::middle, title);
    drawing.text(corner + glm::dvec2(middle, -4), Drawing::Anchor::middle, "warp");
    drawing.text(corner + glm::dvec2(kDisc + 3, middle + 4), Drawing::Anchor::start, "weft");
    drawing.image(corner, std::move(pixels));
}

void draw_errors(Drawing& drawing, const BsdfTable& table, Side side, const ErrorScale& scale,
                 const glm::dvec2& corner) {
    std::vector<size_t> directions;
    for (size_t d = 0; d < table.directions(); ++d)
        if (table.incident[d].side == side)
            directions.push_back(d);
    if (!directions.empty())
        draw_disc(drawing, corner,
                  fmt::format("ε of light from the {}", side == Side::front ? "front" : "back"),
                  error_map(table, directions, scale));
}

/// The colours of ε, with the numbers of both ends.
void draw_scale(Drawing& drawing, const ErrorScale& scale, const glm::dvec2& corner) {
    constexpr int kHeight = 12;
    Canvas colours(kDisc, kHeight, kWhite);
    for (int x = 0; x < kDisc; ++x)
        colours.fill({x, 0}, {x + 1, kHeight},
                     scale.colour(std::lerp(scale.least, scale.most, (x + 0.5) / kDisc)));
    drawing.image(corner, std::move(colours));
    const double base = kHeight + 14;
    drawing.text(corner + glm::dvec2(0, base), Drawing::Anchor::start,
                 fmt::format("ε = {:.3g}", scale.least));
    drawing.text(corner + glm::dvec2(kDisc, base), Drawing::Anchor::end,
                 fmt::format("{:.3g}", scale.most));
}

/// Mean over the bands of the intensity [1/sr] at an angle from the normal in the plane of the
/// weft or of the warp.
double intensity(const BsdfTable& table, size_t direction, int block, bool along_warp,
                 double angle) {
    const double across = std::sin(angle);
    const glm::dvec3 to(along_warp ? 0 : across, along_warp ? across : 0, std::cos(angle));
    const size_t bin = table.exits_of(direction).bin(to);
    double sum = 0;
    for (size_t band = 0; band < table.bands.count(); ++band)
        sum += table.at(direction, block, bin, band);
    return sum / static_cast<double>(table.bands.count());
}

/// The plane of the weft or of the warp: the face upwards, what is reflected in the upper half; the
/// radius is the square root of the intensity.
void draw_polar(Drawing& drawing, const BsdfTable& table, bool along_warp,
                const glm::dvec2& centre) {
    constexpr int kSteps = 178; // of about a degree, none on the horizon
    constexpr double kRadius = kPolar / 2.0;
    std::array<size_t, kTheta.size()> directions;
    std::array<std::array<std::vector<double>, 2>, kTheta.size()> curves;
    double highest = 1e-30;
    for (size_t i = 0; i < kTheta.size(); ++i) {
        directions[i] = nearest_direction(
            table, spherical_direction(radians(kTheta[i]), along_warp ? kPi / 2 : 0.0));
        for (const int block : {0, 1})
            for (int k = 0; k <= kSteps; ++k) {
                const double angle = radians(-89.0 + k);
                curves[i][block].push_back(
                    intensity(table, directions[i], block, along_warp, angle));
                highest = std::max(highest, curves[i][block].back());
            }
    }
    for (const double share : {0.25, 0.5, 1.0}) {
        const double radius = kRadius * std::sqrt(share);
        drawing.circle(centre, radius, kGrid, 1);
        drawing.text(centre + glm::dvec2(3, -radius - 3), Drawing::Anchor::start,
                     fmt::format("{:.2g}{}", share * highest, share == 1 ? " /sr" : ""));
    }
    for (int degrees = 0; degrees < 180; degrees += 30) {
        const glm::dvec2 way = kRadius * glm::dvec2(std::cos(radians(double(degrees))),
                                                    std::sin(radians(double(degrees))));
        const std::array ends{centre - way, centre + way};
        drawing.line(ends, degrees == 0 ? kAxis : kGrid, 1);
    }
    for (size_t i = 0; i < kTheta.size(); ++i) {
        for (const int block : {0, 1}) {
            std::vector<glm::dvec2> points;
            for (int k = 0; k <= kSteps; ++k) {
                const double angle = radians(-89.0 + k);
                const double radius = kRadius * std::sqrt(curves[i][block][k] / highest);
                points.push_back(
                    centre +
                    radius * glm::dvec2(std::sin(angle), (block == 0 ? -1 : 1) * std::cos(angle)));
            }
            drawing.line(points, kColours[i], 1.5);
        }
        // Where the light comes from, and its name.
        const glm::dvec3 light = direction_of(table.incident[directions[i]]);
        const glm::dvec2 towards(along_warp ? light.y : light.x, -light.z);
        const std::array ends{centre + kRadius * towards, centre + 0.92 * kRadius * towards};
        drawing.line(ends, kColours[i], 4);
        const glm::dvec2 key =
            centre + glm::dvec2(-kRadius, kRadius + kKey + kKey * static_cast<double>(i + 1));
        const std::array dash{key + glm::dvec2(0, -4), key + glm::dvec2(24, -4)};
        drawing.line(dash, kColours[i], 3);
        drawing.text(key + glm::dvec2(32, 0), Drawing::Anchor::start,
                     "light from " + name_of(table.incident[directions[i]]));
    }
    drawing.text(centre + glm::dvec2(0, kRadius + kKey), Drawing::Anchor::middle,
                 fmt::format("in the plane of the {}; reflected above, transmitted below",
                             along_warp ? "warp" : "weft"));
}

} // namespace

Drawing table_picture(const BsdfTable& table) {
    constexpr double kRow = kTitle + kDisc + 10;
    constexpr double kPolarTop = 2 * kRow + 50;
    Drawing drawing(kWidth, kPolarTop + kPolar + 5 * kKey);
    const auto corner = [](size_t column, int row) {
        return glm::dvec2(kGap + static_cast<double>(column) * (kDisc + kGap), kTitle + row * kRow);
    };
    for (size_t i = 0; i < kTheta.size(); ++i) {
        const size_t direction =
            nearest_direction(table, spherical_direction(radians(kTheta[i]), 0.0));
        for (const int block : {0, 1})
            draw_disc(drawing, corner(i, block),
                      (block == 0 ? "reflected, " : "transmitted, ") +
                          name_of(table.incident[direction]),
                      hemisphere(table, direction, block));
    }
    const auto [least, most] = std::ranges::minmax(table.accuracy);
    const ErrorScale scale{least, most};
    draw_errors(drawing, table, Side::front, scale, corner(3, 0));
    draw_errors(drawing, table, Side::back, scale, corner(3, 1));
    draw_scale(drawing, scale, corner(3, 1) + glm::dvec2(0, kDisc + 8));
    for (const bool along_warp : {false, true})
        draw_polar(drawing, table, along_warp,
                   {(along_warp ? 0.75 : 0.25) * kWidth, kPolarTop + kPolar / 2.0});
    return drawing;
}

} // namespace rapport
