#pragma once

#include "renderer/core/rng.h"
#include "vgsp/yarn_section.h"

namespace rapport {

/// Part of a fibre that has left the yarn: out of its surface and back, again and again.
struct StrayLoop {
    double height = 0; ///< of the loops over the fibre's place [µm]; 0 = none
    double waves = 0;  ///< loops per µm of the yarn's axis, a whole number of them per cell
    double phase = 0;  ///< [rad]

    double height_at(double s) const; ///< [µm]
};

/// Where one fibre lies in its yarn. A fibre that closes only after several cells is in each a
/// different one of the fibres that the section's symmetry maps on one another.
struct FibreSite {
    glm::dvec2 position; ///< in the section or the single, before it turns [µm]
    double radius;
    struct Turn {
        double in_single, in_ply; ///< [rad], SectionLayout::place
    };
    std::vector<Turn> turns; ///< at the start of each of the cells after which it closes
    StrayLoop loop;
    double thinned = 0; ///< share of its section given up to keep clear of its neighbours
};

/// A displacement of fibres in their yarn's section that varies smoothly along the yarn and across
/// it: two independent Gaussian processes (across, up) of one standard deviation and of
/// autocorrelation exp(−s²/2ℓ² − |p|²/2λ²), as a sum of waves with random phases (Shinozuka,
/// Deodatis 1991, "Simulation of stochastic processes by spectral representation"), exactly
/// periodic in s. Waves longer than the period cannot be, so the tangents turn less than ℓ says
/// where it is not short against the period.
class MigrationField {
  public:
    MigrationField() = default; ///< no displacement
    /// Lengths in µm: standard deviation, ℓ, λ and the period along the yarn.
    MigrationField(double deviation, double along, double across, double period, CounterRng& rng);

    glm::dvec2 at(const glm::dvec2& place, double s) const;
    bool empty() const { return waves_.phase.empty(); }

  private:
    /// An entry of each to a wave: what at() does to all of them goes on in SIMD registers.
    struct Waves {
        std::vector<double> along, across_x, across_y; ///< [turns/µm]
        std::vector<double> phase;                     ///< [turns]
        std::vector<glm::dvec2> amplitude;             ///< [µm]
    };
    Waves waves_;
};

/// The distance across a yarn over which its fibres wander together [µm]: the mean size of its
/// section, a guess. Neighbours keep clear of each other because they are much closer than that.
double migration_width(const SectionOutline& outline);

/// Draws what is irregular about one yarn's fibres: diameters, places, and which of them stray.
/// Then they are moved apart where they overlap and back where they left the yarn, as far as there
/// is room; the packing gives way to the coming migration in the same manner. Fibres that are left
/// without room are made thinner: they keep clear of the others of their single with two standard
/// deviations of migration to spare. Changes nothing for a yarn without irregularity. `cell_length`
/// is that of the axis [µm].
void scatter_fibres(std::vector<FibreSite>& sites, const SectionLayout& section,
                    const YarnSpec& yarn, double cell_length, CounterRng& rng);

} // namespace rapport
