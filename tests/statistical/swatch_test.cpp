#include "renderer/core/parallel.h"
#include "renderer/integrator/path_tracer.h"
#include "tests/support/long_run.h"
#include "tests/support/swatch.h"
#include "vgsp/cloth.h"
#include "vgsp/fibre_step.h"
#include "vgsp/goniophotometer.h"
#include "vgsp/incident_path.h"
#include "vgsp/micro_element.h"

#include <gtest/gtest.h>
#include <numeric>

// From the fibres to the picture: a flat swatch rendered with its measured table, under one disc
// of light, against the goniophotometer's own paths through the fibres.

namespace rapport {
namespace {

using tests::Estimate;
using tests::kDegree;

struct Fibres {
    MicroElement element = build_micro_element(tests::clear_cloth("viscose-plain"));
    kernel::FibreTracer tracer{element.fibres};
    std::vector<FibreOptics> optics{{1.526, {0, 0, 0}, 0}, {1.526, {0, 0, 0}, 0}};
};

/// Four times as fine each way as tables are, whose bins are as wide as the disc is: beside the
/// beam that goes straight on they are off by 5 %.
const DirectionMesh kMesh(96, 64);

/// A quick measurement of all directions, with those of `eyes` (nodes of the grid) measured well.
BsdfTable measured_table(const Fibres& fibres, const std::vector<IncidentDirection>& eyes,
                         uint64_t paths) {
    BsdfTable table = tests::in_mesh(make_full_table(Bands{}, true, true), kMesh);
    measure(fibres.tracer, fibres.optics, {.accuracy = 1e-6, .max_paths = 256}, table);
    BsdfTable fine = tests::in_mesh(make_partial_table(Bands{}, eyes), kMesh);
    measure(fibres.tracer, fibres.optics, {.accuracy = 1e-6, .max_paths = paths}, fine);
    tests::put_in(fine, table);
    return table;
}

/// The same by paths through the fibres: the share that leaves into the disc around `light`.
Estimate by_fibres(const Fibres& fibres, const IncidentDirection& eye, const glm::dvec3& light,
                   uint64_t paths) {
    const std::vector<FibreMedium> media = fibre_media(fibres.optics, 3, fibres.tracer);
    const IncidentPathTracer tracer{fibres.tracer, media, 3, 4096, false};
    const double cos_disc = std::cos(tests::kDiscHalfAngle);
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

TEST(Swatch, RenderedWithItsTableEqualsTheFibresThemselves) {
    const Fibres fibres;
    const uint64_t paths = tests::long_run() ? 8'000'000 : 400'000;
    const std::vector<tests::EyeAndLight> pairs{
        {{Side::front, 30 * kDegree, 45 * kDegree}, 60, 230},
        {{Side::front, 60 * kDegree, 225 * kDegree}, 30, 50},
        {{Side::front, 40 * kDegree, 270 * kDegree}, 128, 95},
        {{Side::back, 30 * kDegree, 30 * kDegree}, 55, 200},
    };
    std::vector<IncidentDirection> eyes;
    for (const tests::EyeAndLight& pair : pairs)
        eyes.push_back(pair.eye);
    const auto table =
        std::make_shared<const TableBsdf>(measured_table(fibres, eyes, paths), "swatch.bsdf");
    for (const tests::EyeAndLight& pair : pairs) {
        const glm::dvec3 eye = towards_light(pair.eye);
        const glm::dvec3 light = pair.light();
        const Estimate fibre = by_fibres(fibres, pair.eye, light, paths);
        const Estimate picture = tests::seen_under_disc(
            tests::surface(tests::level_square(5e-4f, 0), tests::cloth_of(table)), eye, light,
            1e-4f, 4096, 1);
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
