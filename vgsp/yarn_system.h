#pragma once

#include "vgsp/cloth.h"
#include "vgsp/yarn_axis.h"
#include "vgsp/yarn_section.h"

namespace rapport {

/// One kind of yarn of a system.
struct SystemYarn {
    uint32_t kind = 0; ///< index into yarn_kinds()
    std::string place; ///< in the cloth file
    const YarnSpec* yarn = nullptr;
    SectionLayout section;
    double share = 0; ///< of the system's yarns

    double half_height() const { return section.outline.half_height; }
    double half_width() const { return section.outline.half_width; }
};

/// The warp or the weft of the cloth, in one repeat of the draft.
struct YarnSystem {
    std::string name, sett_name;
    double spacing = 0; ///< of its yarns [µm]
    std::vector<SystemYarn> kinds;
    std::vector<int> kind_of;                ///< index into `kinds` of each yarn
    std::vector<std::vector<uint8_t>> above; ///< [yarn][crossing]
    std::vector<YarnAxis> axes;              ///< of each yarn
    int repeats = 1;                         ///< of the draft along the yarns, per cell
    double twist_rounding = 0;               ///< relative

    const SystemYarn& yarn(size_t index) const { return kinds[kind_of[index % kind_of.size()]]; }
    double mean_half_width() const;
    double greatest_height() const; ///< of the yarns' outlines over the cloth's middle [µm]
    double mean_crimp() const;      ///< axis length over straight length − 1
};

struct YarnSystems {
    YarnSystem warp, weft;
};

/// Lays the yarns of `draft`, as weavable() gives it, over and under each other (yarn_settling.h).
/// Throws FileErrors at the cloth's path: yarns too thick for the sett, fibres that do not fit
/// their yarn, a twist that does not close. The systems have at least `least_repeats` of the draft.
YarnSystems lay_systems(const Cloth& cloth, const Draft& draft, int least_repeats = 1);

/// The largest sett for a spacing [µm], in a person's digits, rounded so that it is itself
/// possible.
std::string largest_sett(double spacing);

/// Turns per repeat of the draft, along a yarn's axis, of the symmetry of its section's packing
/// and, if it is plied, of its ring of singles. 0 for what does not turn.
struct SymmetryTurns {
    double packing = 0, plies = 0;
};
SymmetryTurns symmetry_turns(const SystemYarn& yarn, const YarnAxis& axis);

} // namespace rapport
