#pragma once

#include "vgsp/cloth.h"
#include "vgsp/wrap_curve.h"

#include <string>
#include <vector>

namespace rapport {

/// Where a yarn's fibres lie in its section: sites of a hexagonal lattice, spread as wide as the
/// outline holds them. Positions are (across, up) [µm] from the axis.
struct SectionLayout {
    SectionOutline outline; ///< flattening included
    double fibre_radius = 0;
    /// Turns by 2π/symmetry map the (unflattened) packing on itself; `fibres` holds one fibre of
    /// each set that they map on one another. 1 for parallel fibres, which are all listed.
    int symmetry = 1;
    std::vector<glm::dvec2> fibres;
    glm::dvec2 stretch{1, 1}; ///< twisted yarns: the affine map that flattens the packing

    /// A plied yarn's singles, whose packing the above is; they stand on a ring about the axis.
    int plies = 1;
    double ply_ring = 0; ///< its radius before flattening [µm]

    /// Before flattening, two fibres of radii r and q do not overlap at a distance of
    /// clearance·(r + q), whatever their tilts in the yarn.
    double clearance = 1;
    double spacing = 0;     ///< the packing's, before flattening [µm]; infinite for a single fibre
    SectionOutline inner{}; ///< of the yarn or the single, before the flattening of `stretch`

    /// A fibre's position once the packing has turned by `angle` [rad], Z twist positive: from up
    /// towards across, which is anticlockwise for who looks against the axis' direction; and after
    /// that, in a plied yarn, the single about the yarn's axis by `ply_angle` from straight up.
    glm::dvec2 place(const glm::dvec2& fibre, double angle, double ply_angle = 0) const;
    /// How many fibres of the section, or of each single, `fibre` stands for.
    int copies(const glm::dvec2& fibre) const;
};

/// `v` turned by `angle` [rad] from up towards across.
glm::dvec2 turned(const glm::dvec2& v, double angle);

/// The section of `yarn`, without overlaps of its fibres anywhere along a straight yarn:
/// - parallel: laid out in the flattened ellipse, neighbours at least a diameter apart;
/// - twisted: a packing of the highest symmetry that the number of fibres allows (6, 3 or 2),
///   wound round the axis and then flattened, neighbours at least a diameter ÷ cos(largest tilt)
///   apart after flattening, because a tilted fibre's cut is that much longer;
/// - plied: such packings in circles that touch on a ring. A single's section is round in the
///   plane across the yarn: its own width is less by the cosine of its tilt, as plying squeezes it.
/// Throws a FileError at `path`, `place` that names the size needed if the fibres do not fit.
SectionLayout lay_out_section(const YarnSpec& yarn, const std::string& path,
                              const std::string& place);

} // namespace rapport
