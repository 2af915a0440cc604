#pragma once

#include "materials/table/bsdf_table.h"

#include <optional>

namespace rapport {

/// How far a table is from Helmholtz reciprocity. Under an even sky two cells of directions a and
/// b, of solid angle Ω and A = ∫cosθ dω, exchange A_a·P_ab of light one way and A_b·P_ba the other,
/// P_ab the share of the light from a that leaves into b; the two are equal where f(a→b) = f(b→a).
/// The cells are those about the table's directions of incidence, on both sides of the cloth: front
/// to front, back to back, and front to back with back to front. P is summed up over the bins, of
/// the cloth's own dyes, in the mean over the bands.
struct ReciprocityGap {
    /// RMS difference of the two over Ω_a·Ω_b, the pairs weighted by it, in relation to their mean
    /// over all pairs: relative as ε is.
    double gap = 0;
    /// Standard error of `gap`, by a jackknife over the directions of incidence: as if they were a
    /// sample of all.
    double error = 0;
    /// The `gap` that is to be expected of a reciprocal cloth whose table has the noise that this
    /// one claims (its ε, spread over the bins as counts are). A tenth too low at most: that of the
    /// slopes within bins is left out.
    double noise = 0;
};

/// Of a full table; nothing for a partial one, or where nothing is scattered. What incidence is
/// measured at is a point that stands for its cell, and bins are wide far from the highlights, so
/// that a reciprocal cloth has a gap too: 0.045 by Lambert's law, 0.06 with a satin's highlight.
std::optional<ReciprocityGap> reciprocity_gap(const BsdfTable& table);

} // namespace rapport
