#include "vgsp/yarn_section.h"

#include "renderer/core/error.h"
#include "renderer/core/math.h"
#include "vgsp/hexagonal_lattice.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

namespace rapport {
namespace {

using glm::dvec2;

constexpr double kRounding = 1e-9; ///< relative; what may be missing of a length that just fits

[[noreturn]] void does_not_fit(const YarnSpec& yarn, const std::string& path,
                               const std::string& place, double scale) {
    const std::string fibres =
        fmt::format("{} fibres of {:.4g} µm", yarn.fibres, yarn.fibre.diameter_um);
    if (!(scale < 1e6))
        throw FileError(path, place, "a twist that round fibres can follow without overlap",
                        fmt::format("{:g} turns per metre for {}", yarn.twist_per_m, fibres));
    const auto size = [](double width, double height) {
        return width == height ? fmt::format("{:.4g} µm across", width)
                               : fmt::format("{:.4g} µm × {:.4g} µm", width, height);
    };
    // Rounded up, so that the size told is one that does.
    const auto up = [](double x) { return std::ceil(x * 100) / 100; };
    throw FileError(path, place,
                    fmt::format("a section of at least {} to hold {}",
                                size(up(yarn.width_um * scale), up(yarn.height_um * scale)),
                                fibres),
                    size(yarn.width_um, yarn.height_um));
}

SectionLayout parallel_section(const YarnSpec& yarn, SectionOutline outline,
                               const std::string& path, const std::string& place) {
    const double radius = yarn.fibre.diameter_um / 2;
    const auto lattice_at = [&](double scale) {
        return widest_lattice({outline.half_width * scale, outline.half_height * scale}, radius,
                              yarn.fibres);
    };
    const auto fits = [&](const Lattice& lattice) {
        return lattice.spacing >= 2 * radius * (1 - kRounding);
    };
    const Lattice lattice = lattice_at(1);
    if (!fits(lattice)) {
        double low = 1, high = 2;
        while (!fits(lattice_at(high)))
            low = high, high *= 2;
        while (high - low > 1e-4 * low) {
            const double middle = 0.5 * (low + high);
            (fits(lattice_at(middle)) ? high : low) = middle;
        }
        does_not_fit(yarn, path, place, high);
    }
    SectionLayout section{outline, radius, 1, lattice.sites, {1, 1}};
    section.spacing = lattice.spacing;
    section.inner = outline;
    return section;
}

SectionLayout twisted_section(const YarnSpec& yarn, SectionOutline outline, const std::string& path,
                              const std::string& place) {
    const PackingSymmetry symmetry = packing_symmetry(yarn.fibres);
    SectionLayout section{outline,
                          yarn.fibre.diameter_um / 2,
                          symmetry.order,
                          innermost_orbits(symmetry, yarn.fibres),
                          {1 / yarn.flatten, yarn.flatten}};
    section.inner = {yarn.width_um / 2, yarn.width_um / 2};
    section.spacing = HUGE_VAL;
    const double reach = length(section.fibres.back()); // of the outermost fibre, spacing 1
    const double twist = std::abs(yarn.twist_per_m) * 2e-6 * kPi / yarn.flatten; // tilt per radius
    const double wall = section.fibre_radius / yarn.flatten; // a fibre's radius before flattening
    if (reach == 0) {
        if (yarn.width_um / 2 < wall * (1 - kRounding))
            does_not_fit(yarn, path, place, 2 * wall / yarn.width_um);
        section.clearance = 1 / yarn.flatten;
        return section;
    }
    // Outermost radius ρ = reach·spacing with spacing = 2·wall/cos(tilt), tan(tilt) = twist·ρ.
    const double untwisted = 2 * wall * reach;
    const double needed =
        untwisted * twist < 1 ? untwisted / std::sqrt(1 - square(untwisted * twist)) : HUGE_VAL;
    const double radius = yarn.width_um / 2 - wall;
    if (radius < needed * (1 - kRounding))
        does_not_fit(yarn, path, place, 2 * (needed + wall) / yarn.width_um);
    for (dvec2& fibre : section.fibres)
        fibre *= radius / reach;
    section.spacing = radius / reach;
    section.clearance = std::sqrt(1 + square(twist * radius)) / yarn.flatten;
    return section;
}

/// The ring on which `plies` circles of radius 1 touch.
double unit_ring(int plies) { return 1 / std::sin(kPi / plies); }

SectionLayout plied_section(const YarnSpec& yarn, SectionOutline outline, const std::string& path,
                            const std::string& place) {
    const PackingSymmetry symmetry = packing_symmetry(yarn.fibres);
    SectionLayout section{outline,
                          yarn.fibre.diameter_um / 2,
                          symmetry.order,
                          innermost_orbits(symmetry, yarn.fibres),
                          {1 / yarn.flatten, yarn.flatten}};
    section.plies = yarn.plies;
    section.inner = {yarn.width_um / 2, yarn.width_um / 2};
    const double reach = length(section.fibres.back()); // of the outermost fibre, spacing 1

    // In the yarn's section the packing turns with both twists about the single's axis, and that
    // with the plies' about the yarn's; nowhere does a fibre move faster than the two together.
    const double per_turn = 2e-6 * kPi;
    const double ply_twist = std::abs(yarn.ply_twist_per_m) * per_turn;
    const double twist = std::abs(yarn.twist_per_m + yarn.ply_twist_per_m) * per_turn;
    const auto clearance = [&](double ring, double radius) {
        return std::sqrt(1 + square((ply_twist * ring + twist * radius) / yarn.flatten)) /
               yarn.flatten;
    };
    struct Packing {
        double ring, radius; ///< of the singles' axes; of the outermost fibres about them
        double spacing, clearance;
        bool fits;
    };
    const auto packing_at = [&](double scale) {
        const double single = scale * yarn.width_um / 2, ring = single * unit_ring(yarn.plies);
        double low = 0, high = single; // the widest packing that its walls leave in the single
        for (int step = 0; step < 60; ++step) {
            const double radius = 0.5 * (low + high);
            (radius + section.fibre_radius * clearance(ring, radius) <= single ? low : high) =
                radius;
        }
        Packing packing{ring, low, reach > 0 ? low / reach : HUGE_VAL, clearance(ring, low), true};
        packing.fits =
            section.fibre_radius * packing.clearance <= single * (1 + kRounding) &&
            packing.spacing >= 2 * section.fibre_radius * packing.clearance * (1 - kRounding);
        return packing;
    };
    const Packing packing = packing_at(1);
    if (!packing.fits) {
        double scale = 1;
        while (scale < 1e6 && !packing_at(scale).fits)
            scale *= 1.01;
        does_not_fit(yarn, path, place, scale);
    }
    for (dvec2& fibre : section.fibres)
        fibre *= reach > 0 ? packing.radius / reach : 0;
    section.ply_ring = packing.ring;
    section.spacing = packing.spacing;
    section.clearance = packing.clearance;
    return section;
}

} // namespace

dvec2 turned(const dvec2& v, double angle) {
    const double s = std::sin(angle), c = std::cos(angle);
    return {v.x * c + v.y * s, v.y * c - v.x * s};
}

dvec2 SectionLayout::place(const dvec2& fibre, double angle, double ply_angle) const {
    const dvec2 in_single = turned(fibre, angle);
    return stretch * (plies == 1 ? in_single : turned(dvec2(0, ply_ring) + in_single, ply_angle));
}

int SectionLayout::copies(const dvec2& fibre) const { return fibre == dvec2(0) ? 1 : symmetry; }

SectionLayout lay_out_section(const YarnSpec& yarn, const std::string& path,
                              const std::string& place) {
    const auto require = [&](bool sound, const char* expected, double found) {
        if (!sound)
            throw FileError(path, place, expected, fmt::format("{:g}", found));
    };
    require(yarn.fibres >= 1 && yarn.fibres <= 10000, "1 … 10000 fibres", yarn.fibres);
    require(yarn.width_um > 0 && std::isfinite(yarn.width_um), "a positive width_um",
            yarn.width_um);
    require(yarn.height_um > 0 && std::isfinite(yarn.height_um), "a positive height_um",
            yarn.height_um);
    require(yarn.fibre.diameter_um > 0 && std::isfinite(yarn.fibre.diameter_um),
            "a positive diameter_um", yarn.fibre.diameter_um);
    require(yarn.flatten > 0 && yarn.flatten <= 1, "flatten above 0 and up to 1", yarn.flatten);
    require(std::isfinite(yarn.twist_per_m), "a finite twist_per_m", yarn.twist_per_m);

    require(std::isfinite(yarn.ply_twist_per_m), "a finite ply_twist_per_m", yarn.ply_twist_per_m);
    const bool plied = yarn.section == YarnSection::plied;
    require(plied ? yarn.plies >= 2 && yarn.plies <= 6 : yarn.plies == 1,
            plied ? "2 … 6 plies" : "1 ply", yarn.plies);

    const double singles = plied ? 1 + unit_ring(yarn.plies) : 1; // across the yarn
    const SectionOutline outline{singles * yarn.width_um / 2 / yarn.flatten,
                                 singles * yarn.height_um / 2 * yarn.flatten};
    if (yarn.section == YarnSection::parallel)
        return parallel_section(yarn, outline, path, place);
    require(yarn.height_um == yarn.width_um, "a height equal to the width of a twisted yarn",
            yarn.height_um);
    return plied ? plied_section(yarn, outline, path, place)
                 : twisted_section(yarn, outline, path, place);
}

} // namespace rapport
