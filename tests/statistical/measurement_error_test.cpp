#include "tests/support/fibre_assemblies.h"
#include "vgsp/path_tally.h"

#include <gtest/gtest.h>
#include <numeric>

// The errors that a table tells apart, from paths whose distribution over the bins is known.

namespace rapport {
namespace {

BsdfTable one_direction() {
    return make_partial_table(Bands::from_edges({400, 700}), {{Side::front, 0.5, 0}});
}

/// Fluxes into the quarters of all bins of both hemispheres.
using Fluxes = std::vector<double>;

double total(const Fluxes& fluxes) { return std::accumulate(fluxes.begin(), fluxes.end(), 0.0); }

/// A lobe that the mesh resolves poorly where `narrow` is large.
Fluxes lobe(const BsdfTable& table, double narrow, double lean) {
    Fluxes fluxes;
    const size_t bins = table.exits.bins();
    const ExitBins exits = table.exits_of(0);
    for (size_t quarter = 0; quarter < 8 * bins; ++quarter) {
        const size_t bin = quarter / 4 % bins;
        const glm::dvec3 w =
            exits.direction(bin, quarter / 2 % 2 ? 0.5 : -0.5, quarter % 2 ? 0.5 : -0.5);
        const double value = std::exp(narrow * (w.z - 1)) * (1 + lean * std::cos(azimuth(w)));
        fluxes.push_back(value * exits.solid_angle(bin) / 4);
    }
    const double scale = 0.8 / total(fluxes);
    for (double& flux : fluxes)
        flux *= scale;
    return fluxes;
}

/// Tallies `paths` paths, of which the r-th part goes by the r-th of the distributions.
PathTally tally(const BsdfTable& table, const std::vector<Fluxes>& realisations, uint64_t paths,
                uint64_t seed) {
    PathTally tally(table, 0, realisations.size(), 1);
    std::vector<Fluxes> cumulative(realisations.size());
    for (size_t r = 0; r < realisations.size(); ++r)
        std::partial_sum(realisations[r].begin(), realisations[r].end(),
                         std::back_inserter(cumulative[r]));
    PathBatch batch;
    batch.unscattered = batch.capped = batch.lost = {0};
    batch.counts.paths = paths;
    CounterRng rng(seed, Purpose::test, 0, 0);
    for (const Fluxes& cdf : cumulative) {
        const uint64_t own = paths / realisations.size();
        const size_t before = batch.quarters.size();
        for (uint64_t k = 0; k < own; ++k) {
            const auto found = std::upper_bound(cdf.begin(), cdf.end(), rng.uniform());
            if (found == cdf.end())
                continue;
            batch.quarters.push_back(static_cast<uint32_t>(found - cdf.begin()));
            batch.weights.push_back(1);
        }
        batch.paths.push_back(own);
        batch.deposits.push_back(batch.quarters.size() - before);
    }
    tally.add(batch);
    return tally;
}

double true_bin_error(const BsdfTable& table, const Fluxes& fluxes) {
    double sum = 0;
    for (size_t bin = 0; bin < fluxes.size() / 4; ++bin) {
        const double omega = table.exits_of(0).solid_angle(bin % table.exits.bins());
        const double* f = &fluxes[4 * bin];
        const double mean = (f[0] + f[1] + f[2] + f[3]) / omega;
        for (int q = 0; q < 4; ++q)
            sum += omega / 4 * square(f[q] / (omega / 4) - mean);
    }
    return std::sqrt(4 * kPi * sum) / total(fluxes);
}

TEST(BinError, IsWhatAFinerMeshChangesAndNoNoise) {
    const BsdfTable table = one_direction();
    for (const double narrow : {10.0, 100.0}) {
        const Fluxes fluxes = lobe(table, narrow, 0.3);
        const double expected = true_bin_error(table, fluxes);
        double squared = 0, squared2 = 0, noise = 0;
        constexpr int kSeeds = 40;
        for (int seed = 0; seed < kSeeds; ++seed) {
            const PathTally sums = tally(table, {fluxes}, 20'000, seed);
            squared += square(sums.bin_error()) / kSeeds;
            squared2 += square(square(sums.bin_error())) / kSeeds;
            noise += 3 * square(sums.accuracy()) / kSeeds; // what is left in if not subtracted
        }
        const double sigma = std::sqrt((squared2 - square(squared)) / (kSeeds - 1));
        EXPECT_NEAR(squared, square(expected), 3.5 * sigma) << narrow;
        EXPECT_GT(squared + noise - square(expected), 3.5 * sigma) << narrow;
    }
}

TEST(BinError, OfAnEvenIntensityIsNothing) {
    const BsdfTable table = one_direction();
    const PathTally sums = tally(table, {lobe(table, 0, 0)}, 100'000, 1);
    EXPECT_LT(sums.bin_error(), sums.accuracy());
    EXPECT_NEAR(sums.accuracy(), std::sqrt(2.0 * table.exits.bins() / 0.8 / 100'000),
                0.01 * sums.accuracy());
}

/// Realisations that lean to one side or the other, by ±0.3: each intensity is 1 ± 0.3·cosφ times
/// the same, whose mean over two has an error of σ/√2.
TEST(RealisationError, IsTheSpreadOfTheMeansAndNoNoise) {
    const BsdfTable table = one_direction();
    const std::vector<Fluxes> leaning{lobe(table, 2, 0.3), lobe(table, 2, -0.3)};
    double expected = 0, difference2 = 0;
    for (size_t bin = 0; bin < leaning[0].size() / 4; ++bin) {
        double difference = 0;
        for (size_t q = 4 * bin; q < 4 * bin + 4; ++q)
            difference += leaning[0][q] - leaning[1][q];
        difference2 += square(difference) / table.exits_of(0).solid_angle(bin % table.exits.bins());
    }
    // Of two values the variance is half their squared difference, and that of their mean a
    // quarter.
    expected = std::sqrt(4 * kPi * difference2 / 4) / 0.8;
    double squared = 0, squared2 = 0, equal = 0, noise = 0;
    constexpr int kSeeds = 40;
    for (int seed = 0; seed < kSeeds; ++seed) {
        const PathTally sums = tally(table, leaning, 40'000, seed);
        squared += square(sums.realisation_error()) / kSeeds;
        squared2 += square(square(sums.realisation_error())) / kSeeds;
        noise += square(sums.accuracy()) / kSeeds;
        const PathTally same = tally(table, {leaning[0], leaning[0]}, 40'000, seed);
        equal += square(same.realisation_error()) / kSeeds;
    }
    const double sigma = std::sqrt((squared2 - square(squared)) / (kSeeds - 1));
    EXPECT_NEAR(squared, square(expected), 3.5 * sigma);
    EXPECT_GT(squared + noise - square(expected), 3.5 * sigma) << "noise would not be noticed";
    EXPECT_LT(equal, 0.1 * noise); // above 0 only because what falls below is cut
}

/// From the fibres to the file: thicker and thinner fibres in turn are told from one and the same.
TEST(RealisationError, TellsDifferentClothsApart) {
    std::vector<kernel::FibreTracer> same, different;
    for (const double radius : {4.6, 3.4, 4.6}) {
        same.emplace_back(tests::fibre_stack(4, 10, 4, 2));
        different.emplace_back(tests::fibre_stack(4, 10, radius, 2));
    }
    const auto error = [](std::span<const kernel::FibreTracer> realisations) {
        BsdfTable table = one_direction();
        measure(realisations, std::vector<FibreOptics>{{1.5, {0.01}, 0}}, {.accuracy = 0.2}, table);
        EXPECT_TRUE(table.error(0).realisation);
        EXPECT_LE(table.error(0).noise, 0.2);
        return table.largest_error().realisation.value_or(-1);
    };
    EXPECT_LT(error(same), 0.1);
    EXPECT_GT(error(different), 0.2);
}

} // namespace
} // namespace rapport
