#include "renderer/core/bands.h"

#include "renderer/core/math.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <stdexcept>

namespace rapport {
namespace {

/// A Gaussian whose width differs on the two sides of its peak.
struct Lobe {
    double height, peak_nm, below_nm, above_nm;

    /// ∫ of the lobe from its peak to `nm`.
    double integral_to(double nm) const {
        const double width = nm < peak_nm ? below_nm : above_nm;
        return height * width * std::sqrt(kPi / 2) *
               std::erf((nm - peak_nm) / (width * std::numbers::sqrt2));
    }
};

// CIE 1931 2° colour matching functions: multi-lobe fit of Wyman, Sloan & Shirley 2013, table 1.
constexpr Lobe kLobes[] = {
    {1.056, 599.8, 37.9, 31.0}, {0.362, 442.0, 16.0, 26.7}, {-0.065, 501.1, 20.4, 26.2}, // x
    {0.821, 568.8, 46.9, 40.5}, {0.286, 530.9, 16.3, 31.1},                              // y
    {1.217, 437.0, 11.8, 36.0}, {0.681, 459.0, 26.0, 13.8},                              // z
};
constexpr int kLobeAxis[] = {0, 0, 0, 1, 1, 2, 2};

glm::dvec3 integrate_xyz(double from_nm, double to_nm) {
    glm::dvec3 xyz(0);
    for (size_t i = 0; i < std::size(kLobes); ++i)
        xyz[kLobeAxis[i]] += kLobes[i].integral_to(to_nm) - kLobes[i].integral_to(from_nm);
    return xyz;
}

glm::dmat3 from_rows(glm::dvec3 a, glm::dvec3 b, glm::dvec3 c) {
    return glm::transpose(glm::dmat3(a, b, c));
}

/// Linear sRGB of a colour whose X, Y and Z count from 0 (black) to 1 (the white it is seen
/// under): adapted to D65 in Bradford's cone space, so that (1, 1, 1) is white.
glm::dvec3 rgb_from_relative_xyz(const glm::dvec3& xyz) {
    static const glm::dmat3 bradford =
        from_rows({0.8951, 0.2664, -0.1614}, {-0.7502, 1.7135, 0.0367}, {0.0389, -0.0685, 1.0296});
    static const glm::dmat3 rgb_from_xyz = glm::inverse(
        from_rows({0.4124, 0.3576, 0.1805}, {0.2126, 0.7152, 0.0722}, {0.0193, 0.1192, 0.9505}));
    static const glm::dvec3 d65 = glm::inverse(rgb_from_xyz) * glm::dvec3(1);

    const glm::dvec3 gain = (bradford * d65) / (bradford * glm::dvec3(1));
    return rgb_from_xyz * (glm::inverse(bradford) * (gain * (bradford * xyz)));
}

} // namespace

Bands Bands::from_edges(std::vector<double> edges_nm) {
    if (edges_nm.size() < 2)
        throw std::invalid_argument("bands need at least two edges");
    for (size_t i = 0; i < edges_nm.size(); ++i)
        if (!std::isfinite(edges_nm[i]) || edges_nm[i] <= (i ? edges_nm[i - 1] : 0))
            throw std::invalid_argument("band edges must be positive and increasing wavelengths");
    Bands bands;
    bands.names.clear();
    for (size_t b = 0; b + 1 < edges_nm.size(); ++b)
        bands.names.push_back(fmt::format("{:g}-{:g}nm", edges_nm[b], edges_nm[b + 1]));
    bands.edges_nm = std::move(edges_nm);
    return bands;
}

std::vector<Rgb> Bands::to_rgb() const {
    if (is_rgb())
        return {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    std::vector<glm::dvec3> xyz(count());
    glm::dvec3 white(0);
    for (size_t b = 0; b < count(); ++b)
        white += xyz[b] = integrate_xyz(edges_nm[b], edges_nm[b + 1]);

    const double span_nm = edges_nm.back() - edges_nm.front();
    std::vector<Rgb> weights(count());
    for (size_t b = 0; b < count(); ++b) {
        glm::dvec3 share = xyz[b] / white;
        for (int axis = 0; axis < 3; ++axis)
            if (!(white[axis] > 1e-9 * span_nm)) // bands outside this function's range: by width
                share[axis] = (edges_nm[b + 1] - edges_nm[b]) / span_nm;
        weights[b] = Rgb(rgb_from_relative_xyz(share));
    }
    return weights;
}

glm::vec3 relative_xyz(const Rgb& colour) {
    static const glm::dmat3 xyz_from_rgb =
        glm::inverse(glm::dmat3(rgb_from_relative_xyz({1, 0, 0}), rgb_from_relative_xyz({0, 1, 0}),
                                rgb_from_relative_xyz({0, 0, 1})));
    return xyz_from_rgb * glm::dvec3(colour);
}

std::vector<Rgb> rgb_of_samples(std::span<const float> wavelengths_nm) {
    if (wavelengths_nm.empty())
        throw std::invalid_argument("a spectrum needs at least one wavelength");
    std::vector<double> edges;
    for (int nm = 360; nm <= 830; ++nm)
        edges.push_back(nm);
    const std::vector<Rgb> narrow = Bands::from_edges(edges).to_rgb();
    std::vector<Rgb> weights(wavelengths_nm.size(), Rgb(0));
    for (size_t b = 0; b < narrow.size(); ++b) {
        const auto nm = static_cast<float>(0.5 * (edges[b] + edges[b + 1]));
        const auto above = std::ranges::upper_bound(wavelengths_nm, nm);
        const auto high = static_cast<size_t>(above - wavelengths_nm.begin());
        if (high == 0 || high == weights.size()) {
            weights[high == 0 ? 0 : high - 1] += narrow[b];
            continue;
        }
        const float low_nm = wavelengths_nm[high - 1];
        const float t = (nm - low_nm) / (wavelengths_nm[high] - low_nm);
        weights[high - 1] += (1 - t) * narrow[b];
        weights[high] += t * narrow[b];
    }
    return weights;
}

} // namespace rapport
