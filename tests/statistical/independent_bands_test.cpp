#include "vgsp/goniophotometer.h"

#include "tests/support/fibre_assemblies.h"
#include "tests/support/long_run.h"
#include "tests/support/scattering.h"

#include <gtest/gtest.h>

// What a cloth does in one band has nothing to do with the other bands that are measured with it.

namespace rapport {
namespace {

const uint64_t kPaths = tests::long_run() ? 1'000'000 : 100'000;
const std::vector<IncidentDirection> kIncident{{Side::front, radians(40.0), radians(70.0)}};

BsdfTable measured(std::vector<double> absorption, std::vector<double> edges, uint64_t seed) {
    static const kernel::FibreTracer tracer(tests::winding_fibres());
    BsdfTable table = make_partial_table(Bands::from_edges(std::move(edges)), kIncident);
    measure(tracer, std::vector<FibreOptics>{{1.53, std::move(absorption), 0}},
            {.accuracy = 1e-6, .max_paths = kPaths, .seed = seed}, table);
    return table;
}

TEST(IndependentBands, InAnyOrderTheyMeasureTheSame) {
    const BsdfTable table = measured({0, 0.01, 0.2}, {400, 500, 600, 700}, 1);
    const BsdfTable reversed = measured({0.2, 0.01, 0}, {400, 500, 600, 700}, 1);
    for (size_t bin = 0; bin < table.exits.bins(); ++bin)
        for (const int block : {0, 1})
            for (size_t band = 0; band < 3; ++band)
                ASSERT_EQ(table.at(0, block, bin, band), reversed.at(0, block, bin, 2 - band));
    EXPECT_NE(table.absorbed, reversed.absorbed);
}

/// Beside a clear band a dark one is never cut short; alone its paths end in the roulette.
TEST(IndependentBands, OneAloneMeasuresTheSame) {
    const BsdfTable together = measured({0, 0.2}, {400, 500, 600}, 1);
    const BsdfTable alone = measured({0.2}, {500, 600}, 2);
    const BsdfTable other = measured({0.22}, {500, 600}, 3);
    // A path's weight lies in [0, 1]: its variance is at most mean·(1 − mean).
    for (const bool reflected : {true, false}) {
        const auto share = [&](const BsdfTable& table, size_t band) {
            return reflected ? table.reflectance(0)[band] : table.transmittance(0)[band];
        };
        const double expected = share(together, 1);
        const double sigma = std::sqrt(2 * expected * (1 - expected) / static_cast<double>(kPaths));
        EXPECT_NEAR(share(alone, 0), expected, 3 * sigma);
    }
    const double scattered = 1 - together.absorbed[1], dimmer = 1 - other.absorbed[0];
    EXPECT_NEAR(1 - alone.absorbed[0], scattered,
                3 * std::sqrt(2 * scattered * (1 - scattered) / static_cast<double>(kPaths)));
    EXPECT_GT(scattered - dimmer,
              3 * std::sqrt(2 * scattered * (1 - scattered) / static_cast<double>(kPaths)));
}

} // namespace
} // namespace rapport
