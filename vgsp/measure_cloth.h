#pragma once

#include "materials/table/bsdf_table.h"
#include "vgsp/cloth.h"
#include "vgsp/goniophotometer.h"
#include "vgsp/micro_element.h"

#include <array>
#include <functional>

namespace rapport {

/// Micro-elements of one cloth with random numbers of their own, ready for tracing.
struct Realisations {
    MicroElement first;
    std::vector<kernel::FibreTracer> tracers;
};

/// At most `count` ≥ 1, fewer where `memory` [bytes] does not hold as many. The first has the seed
/// given. FileError (at the cloth's path) for a cloth that cannot exist.
Realisations build_realisations(const Cloth& cloth, const MicroElementOptions& geometry, int count,
                                double memory = kMostMemory);

struct MeasureOptions {
    GoniophotometerSettings goniophotometer;
    /// (side, θ, φ) in radians; empty = the whole grid of the sides asked for.
    std::vector<IncidentDirection> incidence;
    bool front = true, back = true;
    /// To be averaged (build_realisations). How many of them stand for a cloth is a matter of the
    /// measurement, like its accuracy, and none of the cloth, whose file tells what they have in
    /// common.
    int realisations = 1;
    double memory = kMostMemory; ///< that they may take together [bytes]
    Checkpoint checkpoint{};
};

struct ClothMeasurement {
    BsdfTable table;
    MicroElement element; ///< the first realisation
    int realisations;     ///< that there were
    GoniophotometerCounts counts;
};

/// What the cloth's fibres are made of, by their kind (yarn_kinds()), and their other dyes.
struct ClothOptics {
    std::vector<FibreOptics> fibres;
    Colourways colourways;

    /// The fibres in other dyes, as one of the colourways has them.
    std::vector<FibreOptics> dyed(const Colourways::mapped_type& dyes) const;
};

/// Of each side the yarns whose highlight it shows, about which its exits are charted: those of
/// which more is seen from straight above, and the warp where both are seen about equally, whatever
/// the seed.
std::array<ConeAxis, 2> facing_yarns(const kernel::FibreTracer& tracer);

/// Wanted colours become absorption, solved for in the cloth's own micro-element by one trace for
/// all of them. FileError (at the cloth's path) for a colour out of reach.
ClothOptics cloth_optics(const Cloth& cloth, const kernel::FibreTracer& tracer,
                         const GoniophotometerSettings& settings);

/// cloth → micro-element → (colours solved for absorption) → table, with everything that decides
/// the result in its metadata. One seed serves the fibres, the colours and the paths; the colours
/// are solved for in the first realisation. FileError (at the cloth's path) for a cloth that cannot
/// exist or a colour out of reach.
ClothMeasurement
measure_cloth(const Cloth& cloth, const MeasureOptions& options,
              const std::function<void(const GoniophotometerProgress&)>& progress = {});

} // namespace rapport
