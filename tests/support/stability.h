#pragma once

#include "tests/support/fibre_assemblies.h"
#include "vgsp/goniophotometer.h"

#include <cmath>
#include <gtest/gtest.h>

// What the stability sweeps share. Each measures the shares of light in one band.

namespace rapport::tests {

/// Where the light from one direction goes; the shares sum to 1.
struct Shares {
    double reflected, transmitted, unscattered, absorbed, capped;
    double paths;
    GoniophotometerCounts counts; ///< of all directions that were measured together

    double sum() const { return reflected + transmitted + unscattered + absorbed + capped; }
    /// One standard error of any of them, or an upper bound of it.
    double error() const { return 0.5 / std::sqrt(paths); }
};

/// Fails if a share is not finite, not in [0, 1], or if they do not account for all light.
inline void expect_sound(const Shares& shares) {
    for (const double share : {shares.reflected, shares.transmitted, shares.unscattered,
                               shares.absorbed, shares.capped}) {
        EXPECT_GE(share, 0); // and so not NaN
        EXPECT_LE(share, 1 + 1e-5);
    }
    EXPECT_NEAR(shares.sum(), 1, 1e-5);
}

struct SweepOptions {
    uint64_t paths = 20'000;
    int max_events = 4096;
    uint64_t seed = 0;
};

inline std::vector<Shares> measure_shares(const kernel::FibreAssembly& assembly,
                                          const FibreOptics& optics,
                                          const std::vector<IncidentDirection>& incident,
                                          const SweepOptions& options = {}) {
    const kernel::FibreTracer tracer(assembly);
    BsdfTable table = make_partial_table(Bands::from_edges({400, 700}), incident);
    const GoniophotometerCounts counts = measure(tracer, std::vector{optics, optics},
                                                 {.accuracy = 1e-6,
                                                  .max_paths = options.paths,
                                                  .max_events = options.max_events,
                                                  .seed = options.seed},
                                                 table);
    for (const float intensity : table.intensity)
        EXPECT_TRUE(std::isfinite(intensity) && intensity >= 0);
    std::vector<Shares> shares;
    for (size_t d = 0; d < table.directions(); ++d)
        shares.push_back({table.reflectance(d)[0], table.transmittance(d)[0], table.unscattered[d],
                          table.absorbed[d], table.capped[d], static_cast<double>(table.paths[d]),
                          counts});
    return shares;
}

inline Shares measure_shares(const kernel::FibreAssembly& assembly, const FibreOptics& optics,
                             const IncidentDirection& incident, const SweepOptions& options = {}) {
    return measure_shares(assembly, optics, std::vector{incident}, options)[0];
}

/// Share of the scattered light that leaves in bins which do not touch the plane u = 0.
inline double share_off_plane(const BsdfTable& table, size_t direction) {
    double off = 0, total = 0;
    for (const int block : {0, 1})
        for (size_t bin = 0; bin < table.exits.bins(); ++bin) {
            const double flux =
                table.at(direction, block, bin, 0) * table.exits_of(direction).solid_angle(bin);
            const DirectionMesh::Bounds bounds = table.exits.bounds(bin);
            total += flux;
            off += bounds.u_low == 0 || bounds.u_high == 0 ? 0 : flux;
        }
    return off / total;
}

/// By how much two shares may differ for their noise.
inline double noise_of_difference(const Shares& a, const Shares& b) {
    return 3.5 * std::hypot(a.error(), b.error());
}

/// Two values that should agree up to noise and `allowed`.
inline void expect_close(const Shares& a, const Shares& b, double allowed = 0) {
    const double noise = noise_of_difference(a, b) + allowed;
    EXPECT_NEAR(a.reflected, b.reflected, noise);
    EXPECT_NEAR(a.transmitted, b.transmitted, noise);
    EXPECT_NEAR(a.unscattered, b.unscattered, noise);
}

} // namespace rapport::tests
