#include "vgsp/goniophotometer.h"

#include "tests/support/fibre_assemblies.h"
#include "tests/support/long_run.h"
#include "vgsp/incident_path.h"

#include <gtest/gtest.h>

namespace rapport {
namespace {

using kernel::FibreAssembly;
using kernel::FibreTracer;

const uint64_t kPaths = tests::long_run() ? 2'000'000 : 100'000;

BsdfTable measured(const FibreTracer& tracer, const FibreOptics& optics,
                   const std::vector<IncidentDirection>& incident, uint64_t seed = 0) {
    BsdfTable table = make_partial_table(Bands{}, incident);
    measure(tracer, std::vector{optics}, {.accuracy = 1e-6, .max_paths = kPaths, .seed = seed},
            table);
    return table;
}

TEST(Energy, NothingIsLostWithoutAbsorption) {
    for (const auto& [assembly, roughness] : {std::pair(tests::winding_fibres(), 0.0),
                                              {tests::reference_stack(), 0.0},
                                              {tests::winding_fibres(), 0.3}}) {
        const BsdfTable table = measured(FibreTracer(assembly), {1.53, {0, 0, 0}, 0, roughness},
                                         {{Side::front, 0, 0},
                                          {Side::front, radians(45.0), radians(90.0)},
                                          {Side::back, radians(80.0), radians(33.0)},
                                          {Side::front, radians(89.9), radians(10.0)}});
        for (size_t d = 0; d < table.directions(); ++d) {
            const double sum = table.reflectance(d)[1] + table.transmittance(d)[1] +
                               table.unscattered[3 * d + 1] + table.capped[3 * d + 1];
            EXPECT_NEAR(sum, 1, 1e-5) << d;
            EXPECT_LT(table.absorbed[3 * d + 1], 1e-6) << d;
            EXPECT_LT(table.capped[3 * d + 1], 2e-3) << d;
        }
        for (const float intensity : table.intensity)
            ASSERT_TRUE(std::isfinite(intensity) && intensity >= 0);
    }
}

TEST(Energy, IndexOneScattersNothing) {
    const std::vector<IncidentDirection> incident{{Side::front, radians(20.0), 0},
                                                  {Side::back, radians(70.0), radians(45.0)}};
    const FibreTracer tracer(tests::reference_stack());
    const BsdfTable clear = measured(tracer, {1, {0, 0, 0}, 0}, incident);
    const BsdfTable dyed = measured(tracer, {1, {0, 0.01, 0.02}, 0, 0.3}, incident);
    for (size_t d = 0; d < incident.size(); ++d) {
        EXPECT_FLOAT_EQ(clear.unscattered[3 * d], 1);
        EXPECT_FLOAT_EQ(dyed.unscattered[3 * d], 1);
        EXPECT_LT(dyed.unscattered[3 * d + 1], 1);
        EXPECT_NEAR(dyed.unscattered[3 * d + 1] + dyed.absorbed[3 * d + 1], 1, 1e-6);
    }
    for (const BsdfTable* table : {&clear, &dyed})
        for (const float intensity : table->intensity)
            ASSERT_EQ(intensity, 0);
    // One flat layer of fibres, seen from above: Beer–Lambert's mean over the chords of a circle,
    // 1 − πσr/2 + … in the cover 2r/p.
    const double radius = 5, pitch = 20, sigma = 0.02;
    double through = 0;
    constexpr int kChords = 100000;
    for (int i = 0; i < kChords; ++i)
        through +=
            std::exp(-2 * sigma * radius * std::sqrt(1 - square(2 * (i + 0.5) / kChords - 1))) /
            kChords;
    const double expected = 1 - 2 * radius / pitch * (1 - through);
    const BsdfTable layer = measured(FibreTracer(tests::fibre_stack(1, pitch, radius, 2)),
                                     {1, {sigma, 0, 0}, 0}, {{Side::front, 0, 0}});
    // A weight of 1 or about `through`: the spread of a path's weight is below 0.07.
    const double sigma_of_mean = 0.07 / std::sqrt(layer.paths[0]);
    EXPECT_NEAR(layer.unscattered[0], expected, 3 * sigma_of_mean);
    EXPECT_GT(std::abs(layer.unscattered[0] - (1 - 2 * radius / pitch * (1 - through) * 0.9)),
              3 * sigma_of_mean);
}

TEST(Energy, OpaqueGridPassesWhatGoesBetween) {
    const double diameter = 10, pitch = 25;
    const FibreTracer tracer(tests::fibre_stack(1, pitch, diameter / 2, 3));
    for (const double degree : {0.0, 30.0, 55.0, 66.0, 75.0}) {
        const double theta = radians(degree);
        // Across the fibres, which run along y, the gap closes; along them it does not.
        const BsdfTable table = measured(tracer, {1.5, {0, 0, 0}, 1},
                                         {{Side::front, theta, 0}, {Side::back, theta, kPi / 2}});
        for (const size_t d : {0, 1}) {
            const double gap =
                std::max(0.0, 1 - diameter / (pitch * (d == 0 ? std::cos(theta) : 1)));
            const double sigma = std::sqrt(gap * (1 - gap) / table.paths[d]);
            EXPECT_NEAR(table.unscattered[3 * d], gap, 3 * sigma) << degree << "° " << d;
            if (degree < 60) { // a fibre 5 % thicker is told apart
                EXPECT_GT(table.unscattered[3 * d] - (1 - 1.05 * (1 - gap)), 3 * sigma);
            }
            EXPECT_NEAR(table.absorbed[3 * d], 1 - table.unscattered[3 * d], 1e-6);
        }
    }
}

/// Black dye ends most paths in the roulette; what it leaves must have the mean of paths without.
TEST(Energy, TheRouletteIsUnbiased) {
    const FibreTracer tracer(tests::reference_stack());
    const FibreOptics dark{1.53, {0.3, 0.3, 0.3}, 0.05};
    const IncidentDirection incident{Side::front, radians(30.0), radians(20.0)};
    const BsdfTable table = measured(tracer, dark, {incident});
    const double with = table.reflectance(0)[0] + table.transmittance(0)[0];

    const std::vector<FibreMedium> media = fibre_media(std::vector{dark}, 3, tracer);
    const IncidentPathTracer without{tracer, media, 3, 4096, false};
    IncidentPath path;
    double sum = 0, sum2 = 0;
    for (uint64_t k = 0; k < kPaths; ++k) {
        CounterRng rng(99, Purpose::test, 0, k);
        without.trace(incident, rng, path);
        const double weight = path.fate == PathFate::scattered ? path.weight(0) : 0;
        sum += weight;
        sum2 += weight * weight;
    }
    const double n = static_cast<double>(kPaths), mean = sum / n;
    const double sigma = std::sqrt((sum2 / n - mean * mean) / n);
    EXPECT_NEAR(with, mean, 3 * 1.5 * sigma);
    EXPECT_GT(std::abs(1.1 * with - mean), 3 * 1.5 * sigma);
}

TEST(Energy, WindowAndSeedChangeNothingButNoise) {
    const std::vector<IncidentDirection> incident{{Side::front, radians(40.0), radians(70.0)}};
    const FibreOptics optics{1.53, {0, 0, 0}, 0};
    const BsdfTable a = measured(FibreTracer(tests::winding_fibres()), optics, incident);
    const BsdfTable b =
        measured(FibreTracer(tests::winding_fibres({31, -17, 5})), optics, incident, 8);
    const double r = a.reflectance(0)[0];
    const double sigma = std::sqrt(2 * r * (1 - r) / kPaths);
    EXPECT_NEAR(b.reflectance(0)[0], r, 3 * sigma);
    EXPECT_NE(b.reflectance(0)[0], r);
    FibreAssembly thicker = tests::winding_fibres();
    for (kernel::FibreChain& chain : thicker.chains)
        chain.radius *= 1.1;
    const BsdfTable c = measured(FibreTracer(thicker), optics, incident);
    EXPECT_GT(std::abs(c.reflectance(0)[0] - r), 3 * sigma);
}

} // namespace
} // namespace rapport
