#include "vgsp/goniophotometer.h"

#include "tests/support/fibre_assemblies.h"
#include "tests/support/long_run.h"
#include "vgsp/measure_cloth.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

namespace rapport {
namespace {

/// Fibres and the direction that their light comes from.
struct Subject {
    kernel::FibreTracer tracer;
    std::vector<FibreOptics> optics;
    IncidentDirection incident;

    BsdfTable measured(double accuracy, uint64_t seed, uint64_t max_paths = 0) const {
        BsdfTable table = make_partial_table(Bands{}, {incident});
        measure(tracer, optics, {.accuracy = accuracy, .max_paths = max_paths, .seed = seed},
                table);
        return table;
    }
};

Subject stack() {
    return {kernel::FibreTracer(tests::fibre_stack(2, 12, 4.6, 2)),
            {{1.53, {0.001, 0.02, 0.1}, 0}},
            {Side::front, radians(35.0), radians(25.0)}};
}

Subject cloth_of(const std::string& name, Side side, double theta, double phi) {
    const Cloth cloth = read_cloth(RAPPORT_SOURCE_DIR "/scenes/cloths/" + name + ".toml");
    kernel::FibreTracer tracer(build_micro_element(cloth, {}).fibres);
    std::vector<FibreOptics> optics = cloth_optics(cloth, tracer, {.colour_paths = 1 << 12}).fibres;
    return {std::move(tracer), std::move(optics), {side, radians(theta), radians(phi)}};
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

struct Moments {
    double sum = 0, sum2 = 0;
    int n = 0;

    void add(double x) {
        sum += x;
        sum2 += x * x;
        ++n;
    }
    double mean() const { return sum / n; }
    /// Of the mean.
    double error() const { return std::sqrt((sum2 / n - square(mean())) / (n - 1)); }
};

/// The claimed error against a long reference, over many independent runs that each stopped where
/// their own pilot and paths told them to.
void expect_honest(const Subject& subject, double asked, int seeds, uint64_t reference_paths) {
    const BsdfTable reference = subject.measured(1e-6, 12345, reference_paths);
    const double reference_error = square(reference.accuracy[0]);
    Moments claimed, actual, reflected, paths;
    int missed = 0;
    for (int seed = 0; seed < seeds; ++seed) {
        const BsdfTable table = subject.measured(asked, seed);
        claimed.add(square(table.accuracy[0]));
        actual.add(squared_error(table, reference) - reference_error);
        reflected.add(table.reflectance(0)[0]);
        paths.add(static_cast<double>(table.paths[0]));
        missed += table.accuracy[0] > asked;
    }
    const double ratio = std::sqrt(claimed.mean() / actual.mean());
    const double sigma =
        0.5 * std::hypot(claimed.error() / claimed.mean(), actual.error() / actual.mean());
    fmt::print("claimed {:.4f}, true {:.4f}: ratio {:.4f} ± {:.4f}; {} of {} above {}; {:.0f} "
               "paths\n",
               std::sqrt(claimed.mean()), std::sqrt(actual.mean()), ratio, sigma, missed, seeds,
               asked, paths.mean());
    // Few seeds tell no ratio to 5 %: of them only what chance cannot have done is told.
    const double bound = tests::long_run() ? 0.05 : 3.5 * sigma;
    EXPECT_NEAR(ratio, 1, bound);
    EXPECT_GT(std::abs(ratio / (tests::long_run() ? 1.1 : 1.2) - 1), bound)
        << "an error claimed too small would pass";
    EXPECT_EQ(missed, 0) << "runs that ended above the accuracy asked for";
    // Paths added where ε was too large hardly bias the mean.
    const double r = reference.reflectance(0)[0];
    const double error = std::sqrt(r / static_cast<double>(reference_paths));
    EXPECT_NEAR(reflected.mean(), r, 3.5 * std::hypot(reflected.error(), error));
}

TEST(GoniophotometerError, IsWhatItClaimsToBe) {
    expect_honest(stack(), 0.8, tests::long_run() ? 400 : 60,
                  tests::long_run() ? 8'000'000 : 1'000'000);
}

const int kSeeds = tests::long_run() ? 200 : 16;
const uint64_t kReferencePaths = tests::long_run() ? 300'000 : 60'000;

TEST(GoniophotometerError, OfAPlainWeave) {
    expect_honest(cloth_of("viscose-plain", Side::front, 30, 20), 0.9, kSeeds, kReferencePaths);
}

/// From the direction where small bins beside the horizon tell the most.
TEST(GoniophotometerError, OfASatin) {
    expect_honest(cloth_of("quickstart", Side::back, 80, 60), 1.1, kSeeds, kReferencePaths);
}

TEST(GoniophotometerError, OfATwillOfTwistedYarns) {
    expect_honest(cloth_of("cotton-twill", Side::front, 60, 130), 1.1, kSeeds, kReferencePaths);
}

TEST(GoniophotometerError, FallsWithTheRootOfThePaths) {
    const Subject subject = stack();
    const BsdfTable few = subject.measured(1e-6, 1, 10'000),
                    many = subject.measured(1e-6, 2, 160'000);
    EXPECT_NEAR(few.accuracy[0] / many.accuracy[0], 4, 0.2);
}

} // namespace
} // namespace rapport
