#include "materials/table/table_bsdf.h"

#include "materials/table/bin_reconstruction.h"
#include "renderer/core/error.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace rapport {
namespace {

constexpr float kOneMinusEpsilon = 0x1.fffffep-1f;

float mean(const Rgb& c) { return (c.r + c.g + c.b) * (1.0f / 3); }

/// Saturated bands lie outside sRGB and have a negative channel: mixed with the grey of the same
/// luminance until there is none. Keeps the luminance, and densities positive.
Rgb into_gamut(const Rgb& c) {
    const float lowest = std::min({c.r, c.g, c.b});
    if (lowest >= 0)
        return c;
    const float grey = std::max(luminance(c), 0.0f);
    return glm::max(grey + (c - grey) * (grey / (grey - lowest)), Rgb(0));
}

Rgb to_rgb(const float* values, const std::vector<Rgb>& band_rgb) {
    Rgb sum(0);
    for (size_t band = 0; band < band_rgb.size(); ++band)
        sum += values[band] * band_rgb[band];
    return into_gamut(sum);
}

/// The nodes about a direction of incidence and their bilinear weights, which sum to 1.
struct Blend {
    std::array<uint32_t, 4> node;
    std::array<float, 4> weight;
};

} // namespace

struct TableBsdf::Implementation {
    BsdfTable table;
    BinLookup lookup;
    size_t bins;
    std::vector<BinPlane> planes;  ///< [D, 2, B]
    std::vector<float> cumulative; ///< [D, 2·B], to 1 (or 0 throughout) over both blocks of a node
    std::vector<Rgb> albedo, unscattered; ///< [D]
    std::vector<float> theta, phi;        ///< axes of the grid; φ closed by 2π

    explicit Implementation(BsdfTable source)
        : table(std::move(source)), lookup(table.exits), bins(table.exits.bins()),
          theta(table.grid_theta.begin(), table.grid_theta.end()),
          phi(table.grid_phi.begin(), table.grid_phi.end()) {
        phi.push_back(static_cast<float>(2 * kPi));
        const std::vector<Rgb> band_rgb = table.bands.to_rgb();
        for (size_t node = 0; node < table.directions(); ++node)
            add_node(node, band_rgb);
    }

    void add_node(size_t node, const std::vector<Rgb>& band_rgb) {
        const size_t bands = band_rgb.size();
        std::vector<Rgb> means(2 * bins);
        for (size_t i = 0; i < means.size(); ++i)
            means[i] = to_rgb(&table.intensity[(node * means.size() + i) * bands], band_rgb);
        for (size_t block = 0; block < 2; ++block) {
            const auto half =
                reconstruct(table.exits, std::span(means).subspan(block * bins, bins));
            planes.insert(planes.end(), half.begin(), half.end());
        }

        glm::dvec3 flux(0);
        std::vector<double> sums;
        double sum = 0;
        for (size_t i = 0; i < means.size(); ++i) {
            const double solid_angle = table.exits.solid_angle(i % bins);
            flux += glm::dvec3(means[i]) * solid_angle;
            sums.push_back(sum += mean(means[i]) * solid_angle);
        }
        for (const double partial : sums)
            cumulative.push_back(sum > 0 ? static_cast<float>(partial / sum) : 0);
        albedo.emplace_back(flux);
        unscattered.push_back(to_rgb(&table.unscattered[node * bands], band_rgb));
    }

    /// Bilinear in (θ, φ), φ round the circle; constant beyond the first and last θ.
    Blend blend(const glm::vec3& eye) const {
        const float eye_theta = std::acos(std::min(std::abs(eye.z), 1.0f));
        const auto above = std::upper_bound(theta.begin(), theta.end(), eye_theta);
        const size_t t1 = std::min<size_t>(above - theta.begin(), theta.size() - 1);
        const size_t t0 = above == theta.begin() ? 0 : above - theta.begin() - 1;
        const float s = t0 == t1 ? 0 : (eye_theta - theta[t0]) / (theta[t1] - theta[t0]);

        const float eye_phi = azimuth(eye);
        const size_t phis = phi.size() - 1;
        const size_t p0 =
            std::upper_bound(phi.begin() + 1, phi.end() - 1, eye_phi) - (phi.begin() + 1);
        const size_t p1 = p0 + 1 == phis ? 0 : p0 + 1;
        const float t = std::min((eye_phi - phi[p0]) / (phi[p0 + 1] - phi[p0]), 1.0f);

        const uint32_t* grid = &table.grid_index[(eye.z > 0 ? 0 : 1) * theta.size() * phis];
        return {{grid[t0 * phis + p0], grid[t0 * phis + p1], grid[t1 * phis + p0],
                 grid[t1 * phis + p1]},
                {(1 - s) * (1 - t), (1 - s) * t, s * (1 - t), s * t}};
    }

    /// The interpolant; everything else follows from it.
    Rgb intensity(const Blend& blend, const glm::vec3& eye, const glm::vec3& light) const {
        const size_t block = (eye.z > 0) == (light.z > 0) ? 0 : 1;
        const BinPosition position = lookup.locate(light);
        Rgb sum(0);
        for (int k = 0; k < 4; ++k)
            if (blend.weight[k] > 0)
                sum += blend.weight[k] *
                       planes[(blend.node[k] * 2 + block) * bins + position.bin].at(position);
        return glm::max(sum, Rgb(0)); // a plane that touches 0 may round below it
    }

    Rgb blended(const Blend& blend, const std::vector<Rgb>& values) const {
        Rgb sum(0);
        for (int k = 0; k < 4; ++k)
            sum += blend.weight[k] * values[blend.node[k]];
        return sum;
    }
};

TableBsdf::TableBsdf(BsdfTable table, const std::string& name) {
    if (table.partial())
        throw FileError(name, "", "a table of the whole grid of incidence",
                        "a partial table of " + std::to_string(table.directions()) +
                            " directions of incidence");
    const size_t side_size = table.grid_theta.size() * table.grid_phi.size();
    for (const size_t side : {0, 1})
        if (table.grid_index[side * side_size] == BsdfTable::kAbsent)
            throw FileError(name, "", "a table of both sides of the cloth",
                            side == 0 ? "no front side" : "no back side");
    implementation_ = std::make_unique<Implementation>(std::move(table));
}

TableBsdf::~TableBsdf() = default;

const BsdfTable& TableBsdf::table() const { return implementation_->table; }

// On the horizon a direction has no side, and nothing scatters.

Rgb TableBsdf::eval(const glm::vec3& eye, const glm::vec3& light) const {
    if (eye.z == 0 || light.z == 0)
        return Rgb(0);
    return implementation_->intensity(implementation_->blend(eye), eye, light);
}

float TableBsdf::pdf(const glm::vec3& eye, const glm::vec3& light) const {
    if (eye.z == 0 || light.z == 0)
        return 0;
    const Implementation& my = *implementation_;
    const Blend blend = my.blend(eye);
    const float albedo = mean(my.blended(blend, my.albedo));
    return albedo > 0 ? mean(my.intensity(blend, eye, light)) / albedo : 0;
}

std::optional<TableBsdf::Sample> TableBsdf::sample(const glm::vec3& eye, float choice,
                                                   const glm::vec2& u) const {
    if (eye.z == 0)
        return std::nullopt;
    const Implementation& my = *implementation_;
    const Blend blend = my.blend(eye);
    const float albedo = mean(my.blended(blend, my.albedo));
    if (!(albedo > 0))
        return std::nullopt;

    // A node by its share of the scattered light; what is left of `choice` is uniform again.
    float left = choice * albedo, share = 0;
    uint32_t node = 0;
    for (int k = 0; k < 4; ++k) {
        const float next = blend.weight[k] * mean(my.albedo[blend.node[k]]);
        if (!(next > 0))
            continue;
        if (share > 0 && left < share)
            break;
        left -= share;
        share = next;
        node = blend.node[k];
    }
    if (!(share > 0))
        return std::nullopt;
    const float again = std::clamp(left / share, 0.0f, kOneMinusEpsilon);

    const float* cumulative = &my.cumulative[node * 2 * my.bins];
    const size_t i = std::upper_bound(cumulative, cumulative + 2 * my.bins, again) - cumulative;
    const BinPlane& plane = my.planes[node * 2 * my.bins + i];
    const float height = mean(plane.mean);
    const glm::vec2 place =
        sample_plane(mean(plane.slope_xi) / height, mean(plane.slope_eta) / height, u);

    const bool reflected = i < my.bins;
    glm::vec3 light =
        my.lookup.direction({static_cast<uint32_t>(reflected ? i : i - my.bins), place.x, place.y});
    if ((eye.z > 0) != reflected)
        light.z = -light.z;
    // From the direction, not from the place: what rounding moved over an edge keeps its value.
    const Rgb intensity = my.intensity(blend, eye, light);
    const float pdf = mean(intensity) / albedo;
    if (!(pdf > 0))
        return std::nullopt;
    return Sample{light, intensity / pdf, pdf};
}

Rgb TableBsdf::unscattered(const glm::vec3& eye) const {
    if (eye.z == 0)
        return Rgb(0);
    return implementation_->blended(implementation_->blend(eye), implementation_->unscattered);
}

Rgb TableBsdf::albedo(const glm::vec3& eye) const {
    if (eye.z == 0)
        return Rgb(0);
    return implementation_->blended(implementation_->blend(eye), implementation_->albedo);
}

} // namespace rapport
