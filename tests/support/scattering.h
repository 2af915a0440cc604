#pragma once

#include "renderer/core/parallel.h"
#include "tests/support/statistics.h"
#include "vgsp/goniophotometer.h"
#include "vgsp/incident_path.h"
#include "vgsp/micro_element.h"

#include <cmath>

// What tests of scattering share: cloths without overlaps, counts of where a fixed number of paths
// leave, and a test for two such counts having the same expectation.

namespace rapport::tests {

/// A yarn of seven loose fibres, thin enough to be woven closely without any overlap.
inline YarnSpec loose_yarn(double diameter_um = 60, double fibre_um = 15) {
    YarnSpec yarn;
    yarn.fibres = 7;
    yarn.width_um = yarn.height_um = diameter_um;
    yarn.fibre.diameter_um = fibre_um;
    yarn.fibre.refractive_index = 1.53;
    return yarn;
}

inline Cloth cloth_of(const Draft& draft, const YarnSpec& warp, const YarnSpec& weft,
                      double ends_per_cm = 70, double picks_per_cm = 70) {
    Cloth cloth;
    cloth.draft = draft;
    cloth.ends_per_cm = ends_per_cm;
    cloth.picks_per_cm = picks_per_cm;
    cloth.warp = warp;
    cloth.weft = weft;
    cloth.path = "test.toml";
    return cloth;
}

/// A plain weave of loose twisted yarns whose packing turns onto itself `steps` times in a repeat
/// and, in share of the twist, `off` besides.
inline Cloth twisted_cloth(int steps, double off = 0) {
    YarnSpec yarn = loose_yarn(90, 14);
    yarn.section = YarnSection::twisted;
    Cloth cloth = cloth_of(named_weave("plain"), yarn, yarn, 45, 45);
    const double length = 2 * 1e4 / 45 * (1 + build_micro_element(cloth).crimp_warp);
    cloth.warp.twist_per_m = cloth.weft.twist_per_m = 1e6 * steps * (1 + off) / (6 * length);
    return cloth;
}

/// A plain weave whose outermost fibres are tilted by `tilt` against the axes of their yarns; S in
/// the weft where `opposed`.
inline Cloth tilted_cloth(double tilt, bool opposed = false) {
    YarnSpec yarn = loose_yarn(90, 14);
    yarn.section = YarnSection::twisted;
    yarn.twist_per_m = 1e6 * std::tan(tilt) / (kPi * (90 - 14));
    YarnSpec weft = yarn;
    if (opposed)
        weft.twist_per_m *= -1;
    return cloth_of(named_weave("plain"), yarn, weft, 45, 45);
}

/// Fibres of two kinds, both clear.
inline std::vector<FibreOptics> clear_fibres(double index = 1.53, size_t bands = 3) {
    const FibreOptics clear{index, std::vector<double>(bands, 0.0), 0};
    return {clear, clear};
}

/// Moves a direction, in (out of) the cloth.
using Motion = glm::dvec3 (*)(const glm::dvec3&);
inline glm::dvec3 unmoved(const glm::dvec3& w) { return w; }
inline glm::dvec3 turned_back(const glm::dvec3& w) { return {w.y, -w.x, w.z}; } ///< from y to x
inline glm::dvec3 half_turned(const glm::dvec3& w) { return {-w.x, -w.y, w.z}; }
inline glm::dvec3 mirrored(const glm::dvec3& w) { return {-w.x, w.y, w.z}; }
inline BsdfTable measured(const kernel::FibreTracer& tracer, std::span<const FibreOptics> optics,
                          const std::vector<IncidentDirection>& incident, uint64_t paths,
                          uint64_t seed = 0) {
    BsdfTable table = make_partial_table(Bands{}, incident);
    measure(tracer, optics, {.accuracy = 1e-6, .max_paths = paths, .seed = seed}, table);
    return table;
}

inline glm::dvec3 turned_over(const glm::dvec3& w) { return {w.x, w.y, -w.z}; }

/// How many paths end where: in the bins of the front, in those of the back, and unscattered.
using ExitCounts = std::vector<double>;

/// Of equally many paths of each incident direction among clear fibres. Incidence and exits are
/// moved before they are counted, so that what is the same after the motion has the same counts.
inline std::vector<ExitCounts> scattered(const kernel::FibreTracer& tracer,
                                         std::span<const FibreOptics> optics,
                                         const std::vector<IncidentDirection>& incident,
                                         uint64_t paths, uint64_t seed, Motion motion = unmoved) {
    const std::vector<FibreMedium> media = fibre_media(optics, 1, tracer);
    const IncidentPathTracer path_tracer{tracer, media, 1, 4096, false};
    const DirectionMesh mesh;
    std::vector<ExitCounts> counts(incident.size(), ExitCounts(2 * mesh.bins() + 1));
    parallel_for(incident.size(), [&](size_t d) {
        // Straight fibres light up exactly on the edge of their own light's bins, where rounding
        // decides; in the bins of light a little beside, they do not.
        const glm::dvec3 beside = motion(towards_light(incident[d])) + glm::dvec3(0.03, 0.05, 0);
        const ExitBins exits(mesh, glm::normalize(beside));
        IncidentPath path;
        for (uint64_t k = 0; k < paths; ++k) {
            CounterRng rng(seed, Purpose::test, d, k);
            path_tracer.trace(incident[d], rng, path);
            const glm::dvec3 w = motion(path.light.direction);
            if (path.fate == PathFate::unscattered)
                ++counts[d].back();
            if (path.fate == PathFate::scattered)
                ++counts[d][(w.z > 0 ? 0 : mesh.bins()) + exits.bin(w)];
        }
    });
    return counts;
}

/// χ² test that two incident directions, by equally many paths, scatter alike: that the counts have
/// the same expectations.
inline ChiSquareResult same_scattering(const ExitCounts& a, const ExitCounts& b) {
    ChiSquareResult result;
    double rare_a = 0, rare_b = 0;
    const auto add = [&](double count_a, double count_b) {
        // Of the paths that end in either, each is as likely from one as from the other.
        result.statistic += square(count_a - count_b) / (count_a + count_b);
        ++result.degrees;
    };
    for (size_t i = 0; i < a.size(); ++i)
        if (a[i] + b[i] < 20) {
            rare_a += a[i];
            rare_b += b[i];
        } else {
            add(a[i], b[i]);
        }
    if (rare_a + rare_b >= 20)
        add(rare_a, rare_b);
    --result.degrees; // both have the same total
    result.p_value = upper_gamma(0.5 * result.degrees, 0.5 * result.statistic);
    return result;
}

/// How far apart two measurements of one incident direction are: the RMS difference of their
/// intensity over its mean, with what noise adds to it taken off; 0 where that is more.
inline double departure(const BsdfTable& a, const BsdfTable& b, size_t direction) {
    const ExitBins exits = a.exits_of(direction);
    double squares = 0, flux = 0;
    for (int block = 0; block < 2; ++block)
        for (size_t bin = 0; bin < a.exits.bins(); ++bin) {
            const double x = a.at(direction, block, bin, 0), y = b.at(direction, block, bin, 0);
            const double omega = exits.solid_angle(bin);
            // A path more or less in a bin is 1/(N·Ω) of intensity.
            const double noise = x / static_cast<double>(a.paths[direction]) +
                                 y / static_cast<double>(b.paths[direction]);
            squares += omega * square(x - y) - noise;
            flux += 0.5 * omega * (x + y);
        }
    return std::sqrt(std::max(0.0, squares) / (4 * kPi)) / (flux / (4 * kPi));
}

} // namespace rapport::tests
