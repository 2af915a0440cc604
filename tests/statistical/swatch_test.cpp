#include "materials/table/table_bsdf.h"
#include "renderer/core/parallel.h"
#include "renderer/integrator/path_tracer.h"
#include "tests/support/long_run.h"
#include "tests/support/small_scenes.h"
#include "vgsp/cloth.h"
#include "vgsp/fibre_step.h"
#include "vgsp/goniophotometer.h"
#include "vgsp/incident_path.h"
#include "vgsp/micro_element.h"

#include <gtest/gtest.h>
#include <numeric>

// From the fibres to the picture: a flat swatch rendered with its measured table, under one disc
// of light of unit radiance and 5° half-angle, against paths through the fibres themselves. The
// pixel is L = ∫_disc f(light → eye) cosθ_light dω = ∫_disc I(eye → ω) dω by reciprocity: the share
// of the light arriving from the eye's direction that leaves into the disc.

namespace rapport {
namespace {

constexpr double kHalfAngle = 5;
constexpr double kDegree = kPi / 180;

Cloth white_plain() {
    Cloth cloth = read_cloth(RAPPORT_SOURCE_DIR "/scenes/cloths/viscose-plain.toml");
    for (FibreSpec* fibre : {&cloth.warp.fibre, &cloth.weft.fibre}) {
        fibre->color.reset();
        fibre->absorption_per_um.reset();
        fibre->surface_absorption = 0;
    }
    return cloth;
}

struct Fibres {
    MicroElement element = build_micro_element(white_plain());
    kernel::FibreTracer tracer{element.fibres};
    std::vector<FibreOptics> optics{{1.526, {0, 0, 0}, 0}, {1.526, {0, 0, 0}, 0}};
};

/// A quick measurement of all directions, with those of `eyes` (nodes of the grid) measured well.
BsdfTable measured_table(const Fibres& fibres, const std::vector<IncidentDirection>& eyes,
                         uint64_t paths) {
    BsdfTable table = make_full_table(Bands{}, true, true);
    measure(fibres.tracer, fibres.optics, {.accuracy = 1e-6, .max_paths = 256}, table);
    BsdfTable fine = make_partial_table(Bands{}, eyes);
    measure(fibres.tracer, fibres.optics, {.accuracy = 1e-6, .max_paths = paths}, fine);
    const size_t stride = table.intensity.size() / table.directions();
    for (size_t e = 0; e < eyes.size(); ++e)
        for (size_t d = 0; d < table.directions(); ++d)
            if (table.incident[d].side == eyes[e].side &&
                std::abs(table.incident[d].theta - eyes[e].theta) < 1e-6 &&
                std::abs(table.incident[d].phi - eyes[e].phi) < 1e-6) {
                std::copy_n(fine.intensity.begin() + e * stride, stride,
                            table.intensity.begin() + d * stride);
                std::copy_n(fine.unscattered.begin() + 3 * e, 3, table.unscattered.begin() + 3 * d);
                table.accuracy[d] = fine.accuracy[e];
            }
    return table;
}

struct Estimate {
    double mean, variance;
};

/// The same by paths through the fibres: the share that leaves into the disc around `light`.
Estimate by_fibres(const Fibres& fibres, const IncidentDirection& eye, const glm::dvec3& light,
                   uint64_t paths) {
    const std::vector<FibreMedium> media = fibre_media(fibres.optics, 3, fibres.tracer);
    const IncidentPathTracer tracer{fibres.tracer, media, 3, 4096, false};
    const double cos_disc = std::cos(kHalfAngle * kDegree);
    constexpr uint64_t kBatch = 4096;
    std::vector<uint64_t> inside((paths + kBatch - 1) / kBatch, 0);
    parallel_for(inside.size(), [&](size_t batch) {
        IncidentPath path;
        for (uint64_t k = batch * kBatch; k < std::min(paths, (batch + 1) * kBatch); ++k) {
            CounterRng rng(91, Purpose::test, 0, k);
            tracer.trace(eye, rng, path);
            inside[batch] += path.fate == PathFate::scattered &&
                             glm::dot(path.light.direction, light) > cos_disc;
        }
    });
    const double share =
        static_cast<double>(std::accumulate(inside.begin(), inside.end(), uint64_t{0})) / paths;
    return {share, share * (1 - share) / paths};
}

Estimate by_render(std::shared_ptr<const TableBsdf> table, const glm::dvec3& eye,
                   const glm::dvec3& light) {
    Params params("test", "cloth", 1);
    Param file;
    file.type = "string";
    file.name = "filename";
    file.strings = {"swatch.bsdf"};
    params.add(file);
    const auto material =
        make_material("cloth", {params, "", [&](const auto&, const auto&) { return table; }});

    // The swatch is a millimetre wide, the disc a thousand times farther away.
    constexpr int kEdges = 256;
    const Frame frame = Frame::about(-glm::vec3(light));
    TriangleMesh disc;
    const float radius = std::tan(kHalfAngle * kDegree);
    disc.positions.push_back(glm::vec3(light));
    for (int i = 0; i < kEdges; ++i) {
        const float angle = 2 * kPi * i / kEdges;
        disc.positions.push_back(glm::vec3(light) +
                                 radius * (std::cos(angle) * frame.x + std::sin(angle) * frame.y));
        disc.triangles.push_back({0, 1 + i, 1 + (i + 1) % kEdges});
    }
    std::vector<Surface> surfaces;
    surfaces.push_back(tests::surface(tests::level_square(5e-4f, 0), material));
    surfaces.push_back(tests::surface(disc, tests::diffuse(0), 1));
    const Scene scene(std::move(surfaces), {},
                      tests::parallel_camera(0.1f * glm::vec3(eye), {}, 1e-4f, 8),
                      tests::settings(4096, 1));
    const Image image = render(scene).image();
    Estimate estimate{0, 0};
    for (int i = 0; i < 64; ++i) {
        estimate.mean += (*image.find("G"))[i] / 64.0;
        estimate.variance += (*image.find("variance.G"))[i] / (64.0 * 64.0);
    }
    return estimate;
}

TEST(Swatch, RenderedWithItsTableEqualsTheFibresThemselves) {
    const Fibres fibres;
    const uint64_t paths = tests::long_run() ? 8'000'000 : 400'000;
    struct Pair {
        IncidentDirection eye;
        double light_theta, light_phi; ///< from the face's normal; beyond 90° = transmitted. The
                                       ///< disc must not cover what the unscattered beam shows.
    };
    const std::vector<Pair> pairs{
        {{Side::front, 30 * kDegree, 45 * kDegree}, 60, 230},
        {{Side::front, 60 * kDegree, 225 * kDegree}, 30, 50},
        {{Side::front, 40 * kDegree, 270 * kDegree}, 128, 95},
        {{Side::back, 30 * kDegree, 30 * kDegree}, 55, 200},
    };
    std::vector<IncidentDirection> eyes;
    for (const Pair& pair : pairs)
        eyes.push_back(pair.eye);
    const auto table =
        std::make_shared<const TableBsdf>(measured_table(fibres, eyes, paths), "swatch.bsdf");
    for (const Pair& pair : pairs) {
        const glm::dvec3 eye = towards_light(pair.eye);
        const glm::dvec3 light =
            spherical_direction(pair.light_theta * kDegree, pair.light_phi * kDegree);
        const Estimate fibre = by_fibres(fibres, pair.eye, light, paths);
        const Estimate picture = by_render(table, eye, light);
        // The table's own noise in the disc is that of as many paths as the reference has; on top
        // of the noise, 3 % for what the bins of the mesh do to a disc of 10°.
        const double sigma = std::sqrt(2 * fibre.variance + picture.variance);
        const double tolerance = 3.5 * sigma + 0.03 * fibre.mean;
        EXPECT_NEAR(picture.mean, fibre.mean, tolerance)
            << "light at " << pair.light_theta << ", " << pair.light_phi;
        EXPECT_LT(tolerance, (tests::long_run() ? 0.09 : 0.3) * fibre.mean);

        // The wrong twin puts the light into the table's incidence slot: off by the ratio of the
        // cosines, which the unequal angles bring out.
        const double wrong = picture.mean * std::abs(std::cos(pair.eye.theta) /
                                                     std::cos(pair.light_theta * kDegree));
        EXPECT_GT(std::abs(wrong - fibre.mean), tolerance);
    }
}

} // namespace
} // namespace rapport
