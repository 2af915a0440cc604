#include "renderer/app/info_picture.h"

#include "materials/table/bsdf_table.h"
#include "renderer/app/canvas.h"
#include "renderer/app/commands.h"
#include "renderer/app/element_picture.h"
#include "renderer/core/error.h"
#include "renderer/core/input_file.h"
#include "vgsp/cloth.h"

#include <algorithm>
#include <array>

namespace rapport {
namespace {

constexpr Canvas::Colour kBackground{1, 1, 1};
constexpr Canvas::Colour kWarpUp{0.1f, 0.1f, 0.12f}, kLine{0.75f, 0.75f, 0.78f};

/// Warp up in black, as on point paper; pick 1 at the bottom, end 1 at the left.
Canvas drawdown(const Draft& draft) {
    constexpr int kSide = 800; // of the longer one, as far as crossings of whole pixels allow
    const int cell = std::clamp(kSide / std::max(draft.ends, draft.picks), 1, 60);
    const int gap = cell > 3 ? 1 : 0;
    Canvas canvas(cell * draft.ends + gap, cell * draft.picks + gap, gap ? kLine : kBackground);
    for (int pick = 0; pick < draft.picks; ++pick)
        for (int end = 0; end < draft.ends; ++end) {
            const glm::ivec2 low(cell * end + gap, cell * (draft.picks - 1 - pick) + gap);
            canvas.fill(low, low + cell - gap, draft.up(end, pick) ? kWarpUp : kBackground);
        }
    return canvas;
}

/// The measured direction of the front side that is nearest to an angle in the plane of the weft.
size_t nearest_direction(const BsdfTable& table, double theta) {
    const glm::dvec3 wanted = spherical_direction(theta, 0.0);
    const auto distance = [&](size_t d) {
        const IncidentDirection& from = table.incident[d];
        return glm::distance(spherical_direction(from.theta, from.phi), wanted) +
               (from.side == Side::front ? 0 : 10);
    };
    size_t nearest = 0;
    for (size_t d = 1; d < table.directions(); ++d)
        if (distance(d) < distance(nearest))
            nearest = d;
    return nearest;
}

Canvas::Colour band_colour(const BsdfTable& table, size_t direction, int block, size_t bin,
                           double brightest) {
    Canvas::Colour colour;
    const size_t bands = table.bands.count();
    for (size_t c = 0; c < 3; ++c) {
        const size_t band = bands == 3 ? c : bands / 2; // RGB, else the middle band in grey
        const double value = table.at(direction, block, bin, band) / brightest;
        colour[static_cast<int>(c)] = static_cast<float>(std::sqrt(value));
    }
    return colour;
}

/// The hemisphere over a disc, the normal in the middle, weft to the right, warp upwards; brightest
/// white, in the square root; where the light comes from, a white dot.
void draw_hemisphere(const BsdfTable& table, size_t direction, int block, const glm::ivec2& corner,
                     int size, Canvas& canvas) {
    const ExitBins exits = table.exits_of(direction);
    double brightest = 1e-30;
    for (size_t bin = 0; bin < table.exits.bins(); ++bin)
        for (size_t band = 0; band < table.bands.count(); ++band)
            brightest = std::max<double>(brightest, table.at(direction, block, bin, band));
    const IncidentDirection& from = table.incident[direction];
    const glm::dvec2 light(spherical_direction(from.theta, from.phi));
    for (int y = 0; y < size; ++y)
        for (int x = 0; x < size; ++x) {
            const glm::dvec2 p(2 * (x + 0.5) / size - 1, 1 - 2 * (y + 0.5) / size);
            if (glm::length(p) >= 1)
                continue;
            const size_t bin = exits.bin({p, std::sqrt(1 - glm::dot(p, p))});
            const bool dot = glm::distance(p, light) < 0.02;
            canvas.set(corner.x + x, corner.y + y,
                       dot ? kBackground : band_colour(table, direction, block, bin, brightest));
        }
}

Canvas hemispheres(const BsdfTable& table) {
    constexpr std::array kTheta{0.0, 30.0, 60.0};
    constexpr int kSize = 260, kGap = 16;
    Canvas canvas(3 * (kSize + kGap) + kGap, 2 * (kSize + kGap) + kGap, kBackground);
    for (int column = 0; column < 3; ++column)
        for (const int block : {0, 1})
            draw_hemisphere(table, nearest_direction(table, radians(kTheta[column])), block,
                            {kGap + column * (kSize + kGap), kGap + block * (kSize + kGap)}, kSize,
                            canvas);
    return canvas;
}

} // namespace

void draw_picture(const std::filesystem::path& file, const std::filesystem::path& png) {
    if (lower_extension(png) != ".png")
        throw FileError("command line", "--picture", "a file that ends in .png", png.string());
    const std::string extension = lower_extension(file);
    if (extension == ".wif")
        drawdown(read_wif(file)).write(png);
    else if (extension == ".toml")
        element_picture(read_cloth(file)).write(png);
    else if (extension == ".bsdf")
        hemispheres(read_table(file)).write(png);
    else
        throw FileError(file.string(), "", "a .wif, .toml or .bsdf, of which there are pictures",
                        "another ending");
}

} // namespace rapport
