#include "materials/table/table_bsdf.h"

#include "materials/table/bin_reconstruction.h"
#include "materials/table/fast_angles.h"
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

/// A BinPlane laid out for one look-up; the fourth lane is not used.
struct PackedPlane {
    Float4 mean, slope_xi, slope_eta;

    explicit PackedPlane(const BinPlane& plane)
        : mean(lanes(plane.mean)), slope_xi(lanes(plane.slope_xi)),
          slope_eta(lanes(plane.slope_eta)) {}
    Float4 at(const BinPosition& p) const { return mean + slope_xi * p.xi + slope_eta * p.eta; }

    static Float4 lanes(const Rgb& c) {
        return Float4([&](int lane) { return lane < 3 ? c[lane] : 0.0f; });
    }
    static Rgb rgb(const Float4& lanes) { return {lanes[0], lanes[1], lanes[2]}; }
};

/// The nodes about a direction of incidence and their bilinear weights, which sum to 1.
struct Blend {
    std::array<uint32_t, 4> node;
    std::array<float, 4> weight;
};

template <class T> Direction<T> spread(const glm::vec3& w) { return {T(w.x), T(w.y), T(w.z)}; }
glm::vec3 to_vector(const Direction<float>& w) { return {w.x, w.y, w.z}; }

} // namespace

struct TableBsdf::Implementation {
    BsdfTable table;
    BinLookup lookup;
    size_t bins;
    std::vector<PackedPlane> planes; ///< [D, 2, B]
    std::vector<float> cumulative; ///< [D, 2·B], to 1 (or 0 throughout) over both blocks of a node
    std::vector<Rgb> albedo, unscattered; ///< [D]
    std::vector<glm::vec3> incident;      ///< [D], unit vectors
    std::vector<float> theta, phi;        ///< axes of the grid; φ closed by 2π
    YarnSystem yarns[2][2];               ///< [side][block], whose highlights are followed

    explicit Implementation(BsdfTable source)
        : table(std::move(source)), lookup(table.exits), bins(table.exits.bins()),
          theta(table.grid_theta.begin(), table.grid_theta.end()),
          phi(table.grid_phi.begin(), table.grid_phi.end()) {
        phi.push_back(static_cast<float>(2 * kPi));
        const std::vector<Rgb> band_rgb = table.bands.to_rgb();
        for (size_t node = 0; node < table.directions(); ++node)
            add_node(node, band_rgb);
        for (const size_t side : {0, 1})
            for (const size_t block : {0, 1})
                yarns[side][block] = error_of_neighbours(YarnSystem::weft, side, block) <
                                             error_of_neighbours(YarnSystem::warp, side, block)
                                         ? YarnSystem::weft
                                         : YarnSystem::warp;
    }

    void add_node(size_t node, const std::vector<Rgb>& band_rgb) {
        const size_t bands = band_rgb.size();
        std::vector<Rgb> means(2 * bins);
        for (size_t i = 0; i < means.size(); ++i)
            means[i] = to_rgb(&table.intensity[(node * means.size() + i) * bands], band_rgb);
        for (size_t block = 0; block < 2; ++block) {
            for (const BinPlane& plane :
                 reconstruct(table.exits, std::span(means).subspan(block * bins, bins)))
                planes.emplace_back(plane);
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
        const IncidentDirection& from = table.incident[node];
        const glm::dvec3 w = spherical_direction(from.theta, from.phi);
        incident.emplace_back(w.x, w.y, from.side == Side::front ? w.z : -w.z);
        unscattered.push_back(to_rgb(&table.unscattered[node * bands], band_rgb));
    }

    /// Squared error of every other node of the grid as foretold by its neighbours in φ.
    double error_of_neighbours(YarnSystem followed, size_t side, size_t block) const {
        const size_t thetas = theta.size(), phis = phi.size() - 1;
        const uint32_t* grid = &table.grid_index[side * thetas * phis];
        double error = 0;
        for (size_t row = 0; row < thetas; ++row)
            for (size_t column = 0; column < phis; column += 2) {
                const uint32_t* ring = grid + row * phis;
                const uint32_t node = ring[column];
                for (uint32_t bin = 0; bin < bins; ++bin) {
                    const glm::vec3 out = lookup.direction({bin, 0, 0});
                    float foretold = 0;
                    for (const size_t step : {size_t{1}, phis - 1}) {
                        const uint32_t from = ring[(column + step) % phis];
                        const auto [source, stretch] =
                            along(followed, spread<float>(out), spread<float>(incident[node]),
                                  spread<float>(incident[from]));
                        const BinPosition place = lookup.locate(to_vector(source));
                        foretold += 0.5f * stretch *
                                    mean(PackedPlane::rgb(plane(from, block, place.bin).at(place)));
                    }
                    error +=
                        table.exits.solid_angle(bin) *
                        square(foretold - mean(PackedPlane::rgb(plane(node, block, bin).mean)));
                }
            }
        return error;
    }

    const PackedPlane& plane(size_t node, size_t block, size_t bin) const {
        return planes[(node * 2 + block) * bins + bin];
    }

    /// Bilinear in (θ, φ), φ round the circle; constant beyond the first and last θ.
    Blend blend(const glm::vec3& eye) const {
        const float eye_theta = fast_acos(std::min(std::abs(eye.z), 1.0f));
        const auto above = std::upper_bound(theta.begin(), theta.end(), eye_theta);
        const size_t t1 = std::min<size_t>(above - theta.begin(), theta.size() - 1);
        const size_t t0 = above == theta.begin() ? 0 : above - theta.begin() - 1;
        const float s = t0 == t1 ? 0 : (eye_theta - theta[t0]) / (theta[t1] - theta[t0]);

        const float eye_phi = fast_azimuth(eye.x, eye.y);
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
        Direction<Float4> node{};
        for (int k = 0; k < 4; ++k) {
            node.x[k] = incident[blend.node[k]].x;
            node.y[k] = incident[blend.node[k]].y;
        }
        const auto [source, stretch] = along(yarns[eye.z > 0 ? 0 : 1][block], spread<Float4>(light),
                                             spread<Float4>(eye), node);
        const std::array<BinPosition, 4> places = lookup.locate(source);
        Float4 sum = 0.0f;
        for (int k = 0; k < 4; ++k)
            sum += (blend.weight[k] * stretch[k]) *
                   plane(blend.node[k], block, places[k].bin).at(places[k]);
        return PackedPlane::rgb(
            max(sum, Float4(0.0f))); // a plane that touches 0 may round below it
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
    return eval_and_pdf(eye, light).intensity;
}

float TableBsdf::pdf(const glm::vec3& eye, const glm::vec3& light) const {
    return eval_and_pdf(eye, light).pdf;
}

TableBsdf::Value TableBsdf::eval_and_pdf(const glm::vec3& eye, const glm::vec3& light) const {
    if (eye.z == 0 || light.z == 0)
        return {Rgb(0), 0};
    const Implementation& my = *implementation_;
    const Blend blend = my.blend(eye);
    const Rgb intensity = my.intensity(blend, eye, light);
    const float albedo = mean(my.blended(blend, my.albedo));
    return {intensity, albedo > 0 ? mean(intensity) / albedo : 0};
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
    const PackedPlane& plane = my.planes[node * 2 * my.bins + i];
    const float height = mean(PackedPlane::rgb(plane.mean));
    const glm::vec2 place = sample_plane(mean(PackedPlane::rgb(plane.slope_xi)) / height,
                                         mean(PackedPlane::rgb(plane.slope_eta)) / height, u);

    const bool reflected = i < my.bins;
    glm::vec3 light =
        my.lookup.direction({static_cast<uint32_t>(reflected ? i : i - my.bins), place.x, place.y});
    if ((eye.z > 0) != reflected)
        light.z = -light.z;

    const auto moved = along(my.yarns[eye.z > 0 ? 0 : 1][reflected ? 0 : 1], spread<float>(light),
                             spread<float>(my.incident[node]), spread<float>(eye));
    light = to_vector(moved.direction);
    if (std::abs(light.z) < kSmallestCosine)
        light.z = (eye.z > 0) == reflected ? kSmallestCosine : -kSmallestCosine;
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
