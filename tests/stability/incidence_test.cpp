#include "vgsp/goniophotometer.h"

#include "tests/support/long_run.h"
#include "tests/support/union_of_disks.h"

#include <gtest/gtest.h>

// Incidence where a direction is special: at the horizon, along a fibre, exactly normal, exactly in
// a plane that is the edge of two bins.

namespace rapport {
namespace {

using tests::Shares;

const FibreOptics kClear{1.53, {0}, 0};
const uint64_t kPaths = tests::long_run() ? 200'000 : 10'000;

const std::vector<double> kTowardsTheHorizon{60, 80, 85, 88, 89, 89.5, 89.8, 89.9};

TEST(Grazing, AllLightIsAccountedForUpToTheHorizon) {
    std::vector<IncidentDirection> incident;
    for (const Side side : {Side::front, Side::back})
        for (const double phi : {0.0, 37.0, 90.0})
            for (const double theta : kTowardsTheHorizon)
                incident.push_back({side, radians(theta), radians(phi)});
    for (const kernel::FibreAssembly& assembly :
         {tests::fibre_stack(3, 12, 4.6, 2), tests::winding_fibres()}) {
        const std::vector<Shares> shares =
            tests::measure_shares(assembly, kClear, incident, {.paths = kPaths / 4});
        for (size_t d = 0; d < incident.size(); ++d) {
            SCOPED_TRACE(testing::Message() << "θ " << degrees(incident[d].theta) << "°, φ "
                                            << degrees(incident[d].phi) << "°");
            tests::expect_sound(shares[d]);
            EXPECT_LT(shares[d].capped, 5e-3);
        }
        // Only a ray that is horizontal to a thousandth may miss all fibres for so long.
        EXPECT_LE(shares[0].counts.lost, shares[0].counts.paths / 10'000);
    }
}

/// The shares have no jump towards the horizon: half a thousandth of a degree changes them by no
/// more than noise.
TEST(Grazing, IsContinuous) {
    std::vector<IncidentDirection> incident;
    for (const double theta : kTowardsTheHorizon)
        for (const double shift : {0.0, 5e-4})
            incident.push_back({Side::front, radians(theta + shift), radians(37.0)});
    const std::vector<Shares> shares =
        tests::measure_shares(tests::winding_fibres(), kClear, incident, {.paths = kPaths});
    for (size_t d = 0; d < incident.size(); d += 2) {
        SCOPED_TRACE(testing::Message() << "θ " << degrees(incident[d].theta) << "°");
        tests::expect_close(shares[d], shares[d + 1]);
    }
    // As the light's way within the cloth grows, all of it meets a fibre, and none goes far down.
    EXPECT_GT(shares.back().reflected, 0.6);
    EXPECT_LT(shares.back().unscattered, 0.01);
}

/// Parallel fibres against every disk asked in double precision, which tells the last two
/// directions apart.
TEST(Grazing, IsWhatDoublePrecisionTells) {
    const tests::ParallelFibres fibres = tests::parallel_fibres();
    Shares before{};
    for (const double theta : kTowardsTheHorizon) {
        SCOPED_TRACE(testing::Message() << "θ " << theta << "°");
        const Shares shares = tests::measure_shares(
            fibres.assembly(), kClear, {Side::front, radians(theta), 0}, {.paths = kPaths});
        const Shares expected = tests::UnionOfDisks(fibres).shares(radians(theta), kPaths);
        tests::expect_close(shares, expected);
        if (theta == kTowardsTheHorizon.back()) {
            EXPECT_GT(expected.reflected - before.reflected,
                      tests::noise_of_difference(expected, before));
        }
        before = shares;
    }
}

TEST(SpecialBeam, AlongAFibre) {
    const double theta = radians(45.0);
    for (const double phi : {0.0, kPi}) {
        const std::vector<Shares> shares =
            tests::measure_shares(tests::zigzag(), kClear,
                                  {{Side::front, theta, phi},
                                   {Side::front, std::nextafter(theta, 1.0), phi},
                                   {Side::front, theta + 1e-9, phi},
                                   {Side::front, theta + 1e-5, phi},
                                   {Side::front, theta, phi + 1e-5}},
                                  {.paths = 2 * kPaths});
        for (const Shares& each : shares) {
            tests::expect_sound(each);
            tests::expect_close(each, shares.back());
        }
    }
}

TEST(SpecialBeam, ExactlyNormal) {
    for (const kernel::FibreAssembly& assembly :
         {tests::fibre_stack(3, 12, 4.6, 2), tests::winding_fibres(), tests::zigzag()}) {
        const std::vector<Shares> shares = tests::measure_shares(assembly, kClear,
                                                                 {{Side::front, 0, 0},
                                                                  {Side::front, 0, kPi / 2},
                                                                  {Side::front, 1e-300, 0},
                                                                  {Side::front, 1e-9, 1},
                                                                  {Side::front, 1e-5, 2}},
                                                                 {.paths = kPaths});
        for (const Shares& each : shares) {
            tests::expect_sound(each);
            tests::expect_close(each, shares.back());
        }
    }
}

/// Light across straight fibres stays in its plane; where that is the edge of two bins, rounding
/// puts it into either, and into no other.
TEST(SpecialBeam, InThePlaneThatDividesBins) {
    const kernel::FibreTracer tracer(tests::fibre_stack(1, 12, 4.6, 2)); // fibres along y
    BsdfTable table =
        make_partial_table(Bands::from_edges({400, 700}), {{Side::front, radians(30.0), 0},
                                                           {Side::front, radians(30.0), kPi},
                                                           {Side::front, radians(30.0), 1e-5}});
    measure(tracer, std::vector{kClear}, {.accuracy = 1e-6, .max_paths = kPaths}, table);
    for (size_t d = 0; d < table.directions(); ++d) {
        EXPECT_GT(table.reflectance(d)[0], 0.05);
        EXPECT_GT(table.transmittance(d)[0], 0.05);
        EXPECT_LT(tests::share_off_plane(table, d), 1e-6);
    }
}

} // namespace
} // namespace rapport
