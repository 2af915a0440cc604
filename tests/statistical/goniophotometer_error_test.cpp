#include "vgsp/goniophotometer.h"

#include "tests/support/fibre_assemblies.h"
#include "tests/support/long_run.h"

#include <gtest/gtest.h>

namespace rapport {
namespace {

BsdfTable measured(double accuracy, uint64_t seed, uint64_t max_paths = 0) {
    static const kernel::FibreTracer tracer(tests::fibre_stack(2, 12, 4.6, 2));
    BsdfTable table = make_partial_table(Bands{}, {{Side::front, radians(35.0), radians(25.0)}});
    measure(tracer, std::vector<FibreOptics>{{1.53, {0.001, 0.02, 0.1}, 0}},
            {.accuracy = accuracy, .max_paths = max_paths, .seed = seed}, table);
    return table;
}

double band_mean(const BsdfTable& table, int block, size_t bin) {
    return (table.at(0, block, bin, 0) + table.at(0, block, bin, 1) + table.at(0, block, bin, 2)) /
           3.0;
}

/// ε² as it really is: the squared difference of two tables, averaged over the sphere, over the
/// square of the mean intensity.
double squared_error(const BsdfTable& estimate, const BsdfTable& reference) {
    double difference = 0, mean = 0;
    const ExitBins exits = estimate.exits_of(0);
    for (int block = 0; block < 2; ++block)
        for (size_t bin = 0; bin < estimate.exits.bins(); ++bin) {
            const double share = exits.solid_angle(bin) / (4 * kPi);
            const double expected = band_mean(reference, block, bin);
            difference += share * square(band_mean(estimate, block, bin) - expected);
            mean += share * expected;
        }
    return difference / square(mean);
}

/// The claimed error against a long reference, over many independent runs that each stopped where
/// their own pilot told them to.
TEST(GoniophotometerError, IsWhatItClaimsToBe) {
    const int seeds = tests::long_run() ? 400 : 60;
    const double asked = 0.8;
    const BsdfTable reference = measured(1e-6, 12345, tests::long_run() ? 8'000'000 : 1'000'000);
    const double reference_error = square(reference.accuracy[0]);
    double claimed = 0, actual = 0, scattered = 0, scattered2 = 0;
    int missed = 0;
    for (int seed = 0; seed < seeds; ++seed) {
        const BsdfTable table = measured(asked, seed);
        claimed += square(table.accuracy[0]) / seeds;
        actual += (squared_error(table, reference) - reference_error) / seeds;
        missed += table.accuracy[0] > asked;
        const double r = table.reflectance(0)[0];
        scattered += r / seeds;
        scattered2 += r * r / seeds;
    }
    const double ratio = std::sqrt(claimed / actual);
    EXPECT_NEAR(ratio, 1, 0.05);
    EXPECT_FALSE(std::abs(ratio / 1.1 - 1) < 0.05) << "an error claimed too small would pass";
    EXPECT_LE(missed, seeds / 20) << "runs that ended above the accuracy asked for";
    // Fixing the number of paths beforehand leaves the mean unbiased.
    const double sigma = std::sqrt((scattered2 - scattered * scattered) / (seeds - 1));
    EXPECT_NEAR(scattered, reference.reflectance(0)[0], 3.5 * sigma);
}

TEST(GoniophotometerError, FallsWithTheRootOfThePaths) {
    const BsdfTable few = measured(1e-6, 1, 10'000), many = measured(1e-6, 2, 160'000);
    EXPECT_NEAR(few.accuracy[0] / many.accuracy[0], 4, 0.2);
}

} // namespace
} // namespace rapport
