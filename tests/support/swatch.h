#pragma once

#include "materials/table/bsdf_table.h"
#include "renderer/integrator/path_tracer.h"
#include "renderer/scene/shape/fibre_swatch.h"
#include "tests/support/small_scenes.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <vector>

// A flat swatch under one disc of light of unit radiance and 5° half-angle, seen from afar. Its
// pixels are L = ∫_disc f(light → eye) cosθ_light dω = ∫_disc I(eye → ω) dω by reciprocity: the
// share of the light arriving from the eye's direction that leaves into the disc.

namespace rapport::tests {

constexpr double kDegree = kPi / 180;
constexpr double kDiscHalfAngle = 5 * kDegree;

/// An eye at a node of the table's grid, and the middle of the disc.
struct EyeAndLight {
    IncidentDirection eye;
    double light_theta, light_phi; ///< [°] from the face's normal; beyond 90° = transmitted. The
                                   ///< disc must not cover what the unscattered beam shows.
    glm::dvec3 light() const {
        return spherical_direction(light_theta * kDegree, light_phi * kDegree);
    }
};

/// An empty table in another mesh of exits.
inline BsdfTable in_mesh(BsdfTable table, const DirectionMesh& mesh) {
    table.exits = mesh;
    table.intensity.assign(table.directions() * 2 * mesh.bins() * table.bands.count(), 0);
    return table;
}

/// `table` with the directions that `fine`, a partial table, has too replaced by its.
inline void put_in(const BsdfTable& fine, BsdfTable& table) {
    const size_t stride = table.intensity.size() / table.directions();
    const size_t bands = table.bands.count();
    for (size_t f = 0; f < fine.directions(); ++f)
        for (size_t d = 0; d < table.directions(); ++d)
            if (table.incident[d].side == fine.incident[f].side &&
                std::abs(table.incident[d].theta - fine.incident[f].theta) < 1e-6 &&
                std::abs(table.incident[d].phi - fine.incident[f].phi) < 1e-6) {
                std::copy_n(fine.intensity.begin() + f * stride, stride,
                            table.intensity.begin() + d * stride);
                std::copy_n(fine.unscattered.begin() + bands * f, bands,
                            table.unscattered.begin() + bands * d);
                table.accuracy[d] = fine.accuracy[f];
            }
}

/// A shipped cloth of clear fibres: nothing but the cap on events takes light away.
inline Cloth clear_cloth(const std::string& name) {
    Cloth cloth = read_cloth(RAPPORT_SOURCE_DIR "/scenes/cloths/" + name + ".toml");
    for (FibreSpec* fibre : {&cloth.warp.fibre, &cloth.weft.fibre}) {
        fibre->color.reset();
        fibre->absorption_per_um.reset();
        fibre->surface_absorption = 0;
    }
    cloth.colourways.clear();
    return cloth;
}

inline Surface fibre_surface(const std::shared_ptr<const FibreSwatch>& swatch,
                             const glm::mat4& to_world = glm::mat4(1)) {
    TriangleMesh mesh = box(1e-6 * swatch->low(), 1e-6 * swatch->high());
    transform(mesh, to_world);
    Surface made = surface(std::move(mesh), diffuse(0));
    made.fibres.emplace(swatch, to_world);
    return made;
}

struct Estimate {
    double mean, variance;
};

/// A disc of light and what it shines with.
struct Disc {
    glm::dvec3 light; ///< where its middle is
    Rgb radiance{1};
};

/// Radiance of the swatch in R, G and B, a level surface around the origin, over a square window of
/// half width `half` [m]. The discs are so far away that all of the window sees them alike.
inline std::array<Estimate, 3> seen_under_discs(Surface swatch, const glm::dvec3& eye,
                                                const std::vector<Disc>& discs, float half,
                                                int samples, int max_depth,
                                                double half_angle = kDiscHalfAngle) {
    constexpr int kEdges = 256, kPixels = 8;
    const float distance = 1e4f * half;
    const float radius = distance * static_cast<float>(std::tan(half_angle));
    std::vector<Surface> surfaces;
    surfaces.push_back(std::move(swatch));
    for (const Disc& disc : discs) {
        const glm::vec3 centre = distance * glm::vec3(disc.light);
        const Frame frame = Frame::about(-glm::vec3(disc.light));
        TriangleMesh mesh;
        mesh.positions.push_back(centre);
        for (int i = 0; i < kEdges; ++i) {
            const float angle = 2 * kPi * i / kEdges;
            mesh.positions.push_back(
                centre + radius * (std::cos(angle) * frame.x + std::sin(angle) * frame.y));
            mesh.triangles.push_back({0, 1 + i, 1 + (i + 1) % kEdges});
        }
        surfaces.push_back(surface(mesh, diffuse(0)));
        surfaces.back().emission = disc.radiance;
    }
    const Scene scene(std::move(surfaces), {},
                      parallel_camera(1e3f * half * glm::vec3(eye), {}, half, kPixels),
                      settings(samples, max_depth));
    const Image image = render(scene).image();
    std::array<Estimate, 3> estimates{};
    constexpr int kCount = kPixels * kPixels;
    for (int c = 0; c < 3; ++c) {
        const std::string channel(1, "RGB"[c]);
        for (int i = 0; i < kCount; ++i) {
            estimates[c].mean += (*image.find(channel))[i] / kCount;
            estimates[c].variance +=
                (*image.find("variance." + channel))[i] / (double(kCount) * kCount);
        }
    }
    return estimates;
}

/// The green one under a single disc.
inline Estimate seen_under_disc(Surface swatch, const glm::dvec3& eye, const glm::dvec3& light,
                                float half, int samples, int max_depth,
                                double half_angle = kDiscHalfAngle) {
    return seen_under_discs(std::move(swatch), eye, {{light}}, half, samples, max_depth,
                            half_angle)[1];
}

} // namespace rapport::tests
