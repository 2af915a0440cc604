#pragma once

#include "tests/support/statistics.h"
#include "vgsp/goniophotometer.h"
#include "vgsp/micro_element.h"

#include <cmath>
#include <functional>

// What tests of the goniophotometer share: cloths without overlaps, a measurement by a fixed number
// of paths, and a test for two measurements having the same expectation.

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

/// Fibres of two kinds, both clear.
inline std::vector<FibreOptics> clear_fibres(double index = 1.53, size_t bands = 3) {
    const FibreOptics clear{index, std::vector<double>(bands, 0.0), 0};
    return {clear, clear};
}

inline BsdfTable measured(const kernel::FibreTracer& tracer, std::span<const FibreOptics> optics,
                          const std::vector<IncidentDirection>& incident, uint64_t paths,
                          uint64_t seed = 0, int max_events = 4096) {
    BsdfTable table = make_partial_table(Bands{}, incident);
    measure(tracer, optics,
            {.accuracy = 1e-6, .max_paths = paths, .max_events = max_events, .seed = seed}, table);
    return table;
}

/// Where a bin of the first table's exits lies among the second's.
using BinMap = std::function<size_t(const DirectionMesh& mesh, size_t bin)>;
inline size_t same_bin(const DirectionMesh&, size_t bin) { return bin; }
/// The bin after a turn by 90° from x to y.
inline size_t turned_bin(const DirectionMesh& mesh, size_t bin) {
    const int ring = mesh.ring_of(bin);
    const size_t first = mesh.ring_first(ring), count = mesh.ring_bins(ring);
    return first + (bin - first + count / 4) % count;
}
/// The bin after mirroring x.
inline size_t mirrored_bin(const DirectionMesh& mesh, size_t bin) {
    const int ring = mesh.ring_of(bin);
    const size_t first = mesh.ring_first(ring), count = mesh.ring_bins(ring);
    return first + (count + count / 2 - 1 - (bin - first)) % count;
}

/// χ² test that two incident directions, measured by equally many paths among clear fibres, scatter
/// alike: the numbers of paths that end in each bin, and unscattered, have the same expectations.
inline ChiSquareResult same_scattering(const BsdfTable& a, size_t direction_a, const BsdfTable& b,
                                       size_t direction_b, const BinMap& map = same_bin) {
    const double paths = static_cast<double>(a.paths[direction_a]);
    ChiSquareResult result;
    double rare_a = 0, rare_b = 0;
    const auto add = [&](double count_a, double count_b) {
        if (count_a + count_b < 20) {
            rare_a += count_a;
            rare_b += count_b;
            return;
        }
        // Of the paths that end in either, each is as likely from one as from the other.
        result.statistic += square(count_a - count_b) / (count_a + count_b);
        ++result.degrees;
    };
    for (int block = 0; block < 2; ++block)
        for (size_t bin = 0; bin < a.exits.bins(); ++bin) {
            const double scale = a.exits.solid_angle(bin) * paths;
            add(std::round(a.at(direction_a, block, bin, 0) * scale),
                std::round(b.at(direction_b, block, map(a.exits, bin), 0) * scale));
        }
    add(std::round(a.unscattered[direction_a * a.bands.count()] * paths),
        std::round(b.unscattered[direction_b * b.bands.count()] * paths));
    if (rare_a + rare_b >= 20)
        add(rare_a, rare_b);
    --result.degrees; // both have the same total
    result.p_value = upper_gamma(0.5 * result.degrees, 0.5 * result.statistic);
    return result;
}

/// How far apart two incident directions scatter among clear fibres: the RMS difference of their
/// intensity over its mean, with what noise adds to it taken off; 0 where that is more.
inline double departure(const BsdfTable& a, size_t direction_a, const BsdfTable& b,
                        size_t direction_b) {
    double squares = 0, flux = 0;
    for (int block = 0; block < 2; ++block)
        for (size_t bin = 0; bin < a.exits.bins(); ++bin) {
            const double x = a.at(direction_a, block, bin, 0), y = b.at(direction_b, block, bin, 0);
            const double omega = a.exits.solid_angle(bin);
            // A path more or less in a bin is 1/(N·Ω) of intensity.
            const double noise = x / static_cast<double>(a.paths[direction_a]) +
                                 y / static_cast<double>(b.paths[direction_b]);
            squares += omega * square(x - y) - noise;
            flux += 0.5 * omega * (x + y);
        }
    return std::sqrt(std::max(0.0, squares) / (4 * kPi)) / (flux / (4 * kPi));
}

} // namespace rapport::tests
