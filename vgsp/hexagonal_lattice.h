#pragma once

#include "vgsp/wrap_curve.h"

#include <vector>

// Where fibres lie side by side: sites of the hexagonal lattice, rows along x, about an origin from
// which the lattice is its own mirror image in x = 0, so that a yarn looks alike from both its
// ends.

namespace rapport {

struct Lattice {
    double spacing = 0;            ///< infinite for a single fibre
    std::vector<glm::dvec2> sites; ///< as many as fibres; empty if they do not fit
};

/// The sites of `fibres` discs of that radius in the ellipse, at the widest spacing and about the
/// best origin. The spacing may be less than their diameter: then they overlap.
Lattice widest_lattice(SectionOutline outline, double radius, int fibres);

/// A centre of the lattice, the symmetry taken about it, and whether a site lies in the centre.
struct PackingSymmetry {
    int order;
    glm::dvec2 origin;
    bool centred;
};

/// The highest symmetry, 6, 3 or 2, that a packing of so many fibres can have.
PackingSymmetry packing_symmetry(int fibres);

/// One site of each orbit of the innermost `fibres` sites under the symmetry, spacing 1.
std::vector<glm::dvec2> innermost_orbits(const PackingSymmetry& symmetry, int fibres);

} // namespace rapport
