#include "tests/support/fibre_assemblies.h"
#include "tests/support/long_run.h"
#include "vgsp/plane_scan.h"

#include <gtest/gtest.h>

// Bands of different refractive index, measured together, against each measured alone.

namespace rapport {
namespace {

const uint64_t kPaths = tests::long_run() ? 1'000'000 : 50'000;
const std::vector<double> kIndices{1.35, 1.5, 1.7}, kAbsorption{0, 0.01, 0.1};
const Colourways kDark{{"dark", {{0.2, 0.1, 0.05}}}};
const IncidentDirection kIncident{Side::front, radians(40.0), radians(70.0)};

const kernel::FibreTracer& stack() {
    static const kernel::FibreTracer tracer(tests::fibre_stack(4, 12, 4.6, 2));
    return tracer;
}

BsdfTable measured(const FibreOptics& optics, const Bands& bands, uint64_t seed,
                   const Colourways& colourways = {}) {
    BsdfTable table = make_partial_table(bands, {kIncident});
    measure(stack(), std::vector{optics}, {.accuracy = 1e-6, .max_paths = kPaths, .seed = seed},
            table, {}, {}, colourways);
    return table;
}

/// The difference of R or T, whichever is larger, in its standard errors: a path's weight lies in
/// [0, 1], so that its variance is at most mean·(1 − mean).
double difference(const BsdfTable& a, size_t band_a, const BsdfTable& b, size_t band_b) {
    double largest = 0;
    for (const bool reflected : {true, false}) {
        const double x = (reflected ? a.reflectance(0) : a.transmittance(0))[band_a];
        const double y = (reflected ? b.reflectance(0) : b.transmittance(0))[band_b];
        largest = std::max(largest, std::abs(x - y) / std::sqrt((x * (1 - x) + y * (1 - y)) /
                                                                static_cast<double>(kPaths)));
    }
    return largest;
}

TEST(Dispersion, BandsTogetherMeasureWhatEachDoesAlone) {
    const BsdfTable together = measured({kIndices, kAbsorption, 0}, Bands{}, 1, kDark);
    EXPECT_EQ(together.paths[0], kPaths); // in each band
    const BsdfTable dark = together.in_colourway("dark", "");
    for (size_t band = 0; band < 3; ++band) {
        const auto alone = [&](const FibreOptics& optics) {
            return measured(optics, Bands::from_edges({400, 700}), 2);
        };
        EXPECT_LT(difference(together, band, alone({kIndices[band], {kAbsorption[band]}, 0}), 0),
                  3.5);
        EXPECT_LT(
            difference(dark, band, alone({kIndices[band], {kDark.at("dark")[0][band]}, 0}), 0),
            3.5);
        // Wrong: the index of another band.
        EXPECT_GT(difference(together, band,
                             alone({kIndices[(band + 1) % 3], {kAbsorption[band]}, 0}), 0),
                  5);
    }
    for (size_t band = 0; band < 3; ++band)
        EXPECT_NEAR(together.reflectance(0)[band] + together.transmittance(0)[band] +
                        together.unscattered[band] + together.absorbed[band] +
                        together.capped[band],
                    1, 1e-5);
}

TEST(Dispersion, OfEqualIndicesIsNone) {
    const BsdfTable one = measured({1.5, kAbsorption, 0}, Bands{}, 1, kDark);
    const BsdfTable three = measured({{1.5, 1.5, 1.5}, kAbsorption, 0}, Bands{}, 1, kDark);
    EXPECT_EQ(one.intensity, three.intensity);
    EXPECT_EQ(one.colourways.at("dark").intensity, three.colourways.at("dark").intensity);
}

/// The error that is claimed of the bands' mean against how far runs of other seeds lie apart.
TEST(Dispersion, ErrorsOfBandsTracedApartAddInSquares) {
    const int seeds = tests::long_run() ? 200 : 40;
    const auto run = [&](uint64_t seed) {
        BsdfTable table = make_partial_table(Bands{}, {kIncident});
        measure(stack(), std::vector<FibreOptics>{{kIndices, {0, 0, 0}, 0}},
                {.accuracy = 1e-6, .max_paths = 2048, .seed = seed}, table);
        return table;
    };
    std::vector<double> sum, sum2;
    double claimed = 0, flux = 0;
    for (int seed = 0; seed < seeds; ++seed) {
        const BsdfTable table = run(static_cast<uint64_t>(seed));
        const size_t bins = table.intensity.size() / 3;
        sum.resize(bins);
        sum2.resize(bins);
        for (size_t bin = 0; bin < bins; ++bin) {
            const float* of_bands = &table.intensity[3 * bin];
            const double mean = (of_bands[0] + of_bands[1] + of_bands[2]) / 3.0;
            sum[bin] += mean;
            sum2[bin] += square(mean);
        }
        claimed += square(table.accuracy[0]) / seeds;
        for (size_t band = 0; band < 3; ++band)
            flux += (table.reflectance(0)[band] + table.transmittance(0)[band]) / 3 / seeds;
    }
    double variance = 0; // the mean over the sphere
    const BsdfTable layout = make_partial_table(Bands{}, {kIncident});
    const ExitBins exits = layout.exits_of(0);
    for (size_t bin = 0; bin < sum.size(); ++bin)
        variance += exits.solid_angle(bin % layout.exits.bins()) / (4 * kPi) *
                    (sum2[bin] - square(sum[bin]) / seeds) / (seeds - 1);
    const double ratio = std::sqrt(claimed) / (std::sqrt(variance) / (flux / (4 * kPi)));
    EXPECT_NEAR(ratio, 1, 0.05);
    EXPECT_GT(std::abs(ratio * std::sqrt(3.0) - 1), 0.05) << "as if they shared their paths";
}

TEST(Dispersion, IsSeenInAScanToo) {
    const GoniophotometerSettings settings{.accuracy = 1e-6, .max_paths = 200'000};
    const std::vector incident{kIncident};
    const PlaneScan together =
        scan_planes({&stack(), 1}, std::vector<FibreOptics>{{kIndices, kAbsorption, 0}}, Bands{},
                    incident, settings)[0];
    EXPECT_EQ(together.paths, 200'000u);
    for (size_t band = 0; band < 3; ++band) {
        const auto excess = [&](double index) {
            const PlaneScan alone = scan_planes(
                {&stack(), 1}, std::vector<FibreOptics>{{index, {kAbsorption[band]}, 0}},
                Bands::from_edges({400, 700}), incident, settings)[0];
            double chi2 = 0;
            int degrees = 0;
            for (size_t bin = 0; bin < alone.intensity.size(); ++bin) {
                const double variance =
                    square(alone.error[bin]) + square(together.error[3 * bin + band]);
                if (variance == 0 || alone.intensity[bin] < 4 * alone.error[bin])
                    continue;
                chi2 +=
                    square(alone.intensity[bin] - together.intensity[3 * bin + band]) / variance;
                ++degrees;
            }
            return (chi2 - degrees) / std::sqrt(2.0 * degrees);
        };
        EXPECT_LT(excess(kIndices[band]), 4);
        EXPECT_GT(excess(kIndices[(band + 1) % 3]), 10);
    }
}

} // namespace
} // namespace rapport
