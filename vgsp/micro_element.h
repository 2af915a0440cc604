#pragma once

#include "renderer/core/stop_signal.h"
#include "renderer/kernel/fibres.h"
#include "vgsp/cloth.h"

namespace rapport {

/// The kinds of fibre in a cloth whose ends are all alike, and its picks; in general a fibre's kind
/// is an index into yarn_kinds().
enum FibreKind : uint32_t { kWarpFibre = 0, kWeftFibre = 1 };

constexpr double kMostMemory = 4e9; ///< that all fibres of a measurement may take [bytes]

/// The repeat of a cloth as explicit fibres, in µm: x = weft, y = warp, z = face; end 1 and pick 1
/// lie at half a spacing from the origin; z = 0 is the cloth's middle.
struct MicroElement {
    kernel::FibreAssembly fibres; ///< chain kind = index into yarn_kinds()

    int repeats_x = 1, repeats_y = 1; ///< draft repeats per cell, more than one where twist asks
    size_t segments = 0;
    double memory = 0;                     ///< that it takes to trace light in it, at most [bytes]
    double thickness_um = 0;               ///< of the yarns' outlines
    double warp_cover = 0, weft_cover = 0; ///< shares of area that the yarns' outlines cover
    double cover_factor = 0;               ///< of both together
    double overlap_fraction = 0; ///< share of sampled fibre surface that lies inside another fibre
    double thinned = 0;          ///< share of the fibres' volume given up so that they keep clear
    double twist_rounding_warp = 0, twist_rounding_weft = 0; ///< relative; the largest of all yarns
    /// Of the fibres, from their lengths and densities; nothing where a density is not known.
    std::optional<double> mass_g_per_m2;
    double crimp_warp = 0, crimp_weft = 0; ///< axis length over straight length − 1
};

/// Options for studies of the method; the defaults are what a cloth is measured with.
struct MicroElementOptions {
    double max_turn_degrees = 1; ///< largest turn of a fibre between two segments
    bool dither = true;          ///< shift each fibre's joints along it at random
    uint64_t seed = 0;
    /// Repeats of the draft along both yarns that the cell has at least: the paper's extended
    /// micro-element. Over all of the cell twist is rounded by half a step of the packing at most:
    /// the less, the longer the cell, and not at all where it closes there.
    int least_repeats = 1;
    StopSignal stopped{}; ///< asked before each fibre is wound
};

/// Builds the micro-element (the paper, section 3). FileError (at the cloth's path) where the
/// cloth cannot exist: yarns too thick for the sett, fibres that do not fit their yarn. Throws
/// Stopped when told to stop.
MicroElement build_micro_element(const Cloth& cloth, const MicroElementOptions& options = {});

} // namespace rapport
