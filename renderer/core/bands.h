#pragma once

#include <glm/glm.hpp>
#include <span>
#include <string>
#include <vector>

namespace rapport {

using Rgb = glm::vec3; ///< linear, sRGB primaries

/// The wavelength bands that a cloth is measured in. Without edges they are the three linear RGB
/// bands ("R", "G", "B"); with edges, band b spans [edges_nm[b], edges_nm[b+1]].
struct Bands {
    std::vector<std::string> names{"R", "G", "B"};
    std::vector<double> edges_nm; ///< empty, or names.size() + 1 increasing wavelengths

    size_t count() const { return names.size(); }
    bool is_rgb() const { return edges_nm.empty(); }
    static Bands from_edges(std::vector<double> edges_nm);

    /// One weight triple per band; Σ value_b · to_rgb()[b] is the colour under an equal-energy
    /// light, and a value of 1 in every band gives (1, 1, 1). For RGB the identity; else from the
    /// CIE 1931 2° functions in the fit of Wyman, Sloan & Shirley 2013 (JCGT 2(2)), integrated
    /// over each band.
    std::vector<Rgb> to_rgb() const;

    bool operator==(const Bands&) const = default;
};

/// The same for a spectrum that is linear between its values at `wavelengths_nm` (ascending) and
/// constant beyond them: one weight triple per value, seen from 360 to 830 nm.
std::vector<Rgb> rgb_of_samples(std::span<const float> wavelengths_nm);

/// X, Y and Z of a linear RGB colour relative to the white it is seen under: (1, 1, 1) is white, as
/// under an equal-energy light. The inverse of the way from bands to RGB.
glm::vec3 relative_xyz(const Rgb& colour);

/// Rec. 709 luminance of a linear RGB colour.
inline float luminance(const Rgb& c) { return 0.2126f * c.r + 0.7152f * c.g + 0.0722f * c.b; }

} // namespace rapport
