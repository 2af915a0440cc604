#include "materials/table/measured_brdf.h"

#include <algorithm>
#include <cmath>

namespace rapport {
namespace {

float bilinear(const MeasuredGrid& grid, const glm::vec2& place) {
    const GridCell cell = grid_cell(grid.rows, grid.columns, place);
    const float* at = &grid.values[cell.row * grid.columns + cell.column];
    return std::lerp(std::lerp(at[0], at[1], cell.x),
                     std::lerp(at[grid.columns], at[grid.columns + 1], cell.x), cell.y);
}

MeasuredGrid constant(float value) { return {2, 2, std::vector<float>(4, value)}; }

/// The colours of a grid that has a slice per channel.
std::vector<Rgb> colours_of(const MeasuredGrid& grid, std::span<const Rgb> channel_rgb) {
    const size_t slice = grid.rows * grid.columns, channels = channel_rgb.size();
    std::vector<Rgb> colours(grid.values.size() / channels, Rgb(0));
    for (size_t i = 0; i < grid.values.size(); ++i) {
        const size_t channel = i / slice % channels;
        colours[i / slice / channels * slice + i % slice] += grid.values[i] * channel_rgb[channel];
    }
    for (Rgb& colour : colours)
        colour = glm::max(colour, Rgb(0)); // spectra of saturated colours lie outside sRGB
    return colours;
}

float turn_of(const glm::vec3& direction) {
    return std::atan2(direction.y, direction.x) / static_cast<float>(2 * kPi);
}

} // namespace

MeasuredBrdf::MeasuredBrdf(const MeasuredFields& fields)
    : theta_(fields.theta), phi_(fields.phi), isotropic_(fields.isotropic()),
      symmetry_(isotropic_ ? 1 : fields.symmetry()),
      ndf_(fields.jacobian ? fields.ndf : constant(1)),
      sigma_(fields.jacobian ? fields.sigma : constant(0.25f)),
      vndf_(fields.vndf.values, fields.vndf.rows, fields.vndf.columns),
      luminance_(fields.luminance.values, fields.luminance.rows, fields.luminance.columns),
      side_(fields.luminance.rows),
      colours_(fields.rgb.empty() ? colours_of(fields.spectra, rgb_of_samples(fields.wavelengths))
                                  : colours_of(fields.rgb, Bands{}.to_rgb())) {
    for (const float phi : phi_)
        for (const float theta : theta_)
            albedo_.push_back(albedo_at(theta, phi));
}

MeasuredBrdf::Incidence MeasuredBrdf::incidence(const glm::vec3& eye) const {
    Incidence from{eye, {1, 1}, 0, {}, 0};
    if (symmetry_ >= 2) {
        from.mirror.y = eye.y >= 0 ? -1.0f : 1.0f;
        from.mirror.x = symmetry_ == 2 ? from.mirror.y : eye.x >= 0 ? -1.0f : 1.0f;
        from.eye = {eye.x * from.mirror.x, eye.y * from.mirror.y, eye.z};
    }
    const float theta = square(measured_place(from.eye).x) * static_cast<float>(kPi / 2);
    const float turns = turn_of(from.eye);
    if (isotropic_)
        from.turns = turns;
    from.slices = blend_slices(phi_, turns * static_cast<float>(2 * kPi), theta_, theta);
    const float sigma = bilinear(sigma_, measured_place(from.eye));
    from.scale = sigma > 0 ? 0.25f / sigma : 0;
    return from;
}

glm::vec3 MeasuredBrdf::half_vector(const Incidence& from, glm::vec2 place) const {
    place.y += from.turns;
    return measured_direction(place);
}

Rgb MeasuredBrdf::colour(const SliceBlend& slices, const glm::vec2& s) const {
    const GridCell cell = grid_cell(side_, side_, s);
    Rgb sum(0);
    for (size_t k = 0; k < slices.slice.size(); ++k) {
        const Rgb* at = &colours_[(slices.slice[k] * side_ + cell.row) * side_ + cell.column];
        sum += slices.weight[k] * glm::mix(glm::mix(at[0], at[1], cell.x),
                                           glm::mix(at[side_], at[side_ + 1], cell.x), cell.y);
    }
    return sum;
}

MeasuredBrdf::Value MeasuredBrdf::eval_and_pdf(const glm::vec3& eye, const glm::vec3& light) const {
    const Incidence from = incidence(eye);
    const glm::vec3 to(light.x * from.mirror.x, light.y * from.mirror.y, light.z);
    const glm::vec3 sum = from.eye + to;
    const float length = glm::length(sum);
    if (!(length > 0))
        return {Rgb(0), 0};
    // Mirroring at m and at −m is the same, and the one above the surface is the one in the file.
    const glm::vec3 m = sum / std::copysign(length, sum.z);
    const float jacobian = measured_jacobian(from.eye, m);
    if (!(jacobian > 0))
        return {Rgb(0), 0};
    glm::vec2 place = measured_place(m);
    place.y -= from.turns;
    place.y -= std::floor(place.y);

    const MarginalWarp::Point warped = vndf_.invert(from.slices, place);
    const float pdf = luminance_.pdf(from.slices, warped.position) * warped.pdf / jacobian;
    if (!(light.z > 0))
        return {Rgb(0), pdf};
    return {colour(from.slices, warped.position) * (from.scale * bilinear(ndf_, place)), pdf};
}

glm::vec3 MeasuredBrdf::sample(const glm::vec3& eye, const glm::vec2& u) const {
    const Incidence from = incidence(eye);
    const glm::vec2 s = luminance_.sample(from.slices, u).position;
    const glm::vec3 m = half_vector(from, vndf_.sample(from.slices, s).position);
    const glm::vec3 to = glm::normalize(2 * glm::dot(m, from.eye) * m - from.eye);
    return {to.x * from.mirror.x, to.y * from.mirror.y, to.z};
}

Rgb MeasuredBrdf::albedo(const glm::vec3& eye) const {
    const SliceBlend slices = incidence(eye).slices;
    Rgb sum(0);
    for (size_t k = 0; k < slices.slice.size(); ++k)
        sum += slices.weight[k] * albedo_[slices.slice[k]];
    return sum;
}

/// By midpoints of the square that `vndf_` maps to half vectors.
Rgb MeasuredBrdf::albedo_at(float theta, float phi) const {
    constexpr int kSteps = 64;
    const glm::vec3 eye = spherical_direction(theta, phi);
    const Incidence from = incidence(eye);
    glm::dvec3 sum(0);
    for (int i = 0; i < kSteps; ++i)
        for (int j = 0; j < kSteps; ++j) {
            const glm::vec2 s((static_cast<float>(j) + 0.5f) / kSteps,
                              (static_cast<float>(i) + 0.5f) / kSteps);
            const MarginalWarp::Point place = vndf_.sample(from.slices, s);
            const glm::vec3 m = half_vector(from, place.position);
            const glm::vec3 to = 2 * glm::dot(m, from.eye) * m - from.eye;
            if (to.z > 0 && place.pdf > 0)
                sum += colour(from.slices, s) * (from.scale * bilinear(ndf_, place.position) *
                                                 measured_jacobian(from.eye, m) / place.pdf);
        }
    return Rgb(sum / double(square(kSteps)));
}

} // namespace rapport
