#pragma once

#include "vgsp/goniophotometer.h"

#include <optional>

namespace rapport {

/// Finds the dye for a wanted colour. One set of paths through the undyed cloth, kept as their
/// lengths inside fibres, serves every dye: for fixed geometry absorption only changes the paths'
/// weights ("white Monte Carlo").
///
/// The albedo that a dye is solved for is what it controls: the share of the light the fibres
/// scatter, to either side, that is not absorbed, under diffuse light (radiance equal from all
/// directions of the face side), as if every fibre of the cloth had that dye. Clear fibres without
/// surface absorption have albedo 1. Light that passes between the fibres does not count.
class ColourSolver {
  public:
    /// `optics` gives refractive indices and surface absorption; its volume absorption is ignored.
    /// Of the settings, `colour_paths`, `max_events`, `seed` and `stopped` count here;
    /// the last is asked before each path and while a dye is solved for, which throws Stopped.
    ColourSolver(const kernel::FibreTracer& tracer, std::span<const FibreOptics> optics,
                 const GoniophotometerSettings& settings);

    /// [1] for a volume absorption [1/µm] ≥ 0. Standard error 0.5/√colour_paths at most.
    double albedo(double absorption_per_um) const;
    double greatest_albedo() const { return albedo(0); }
    /// What no dye takes away: light reflected before it enters a fibre.
    double least_albedo() const;
    /// The volume absorption [1/µm] that gives `albedo`; nothing for one out of reach.
    std::optional<double> absorption_for(double albedo) const;

  private:
    struct WhitePath {
        double length; ///< inside fibres [µm]
        double weight; ///< left by surface absorption
    };
    StopSignal stopped_;
    std::vector<WhitePath> paths_;
};

} // namespace rapport
