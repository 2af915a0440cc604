#include "vgsp/goniophotometer.h"

#include "tests/support/fibre_assemblies.h"
#include "tests/support/long_run.h"
#include "tests/support/scattering.h"
#include "vgsp/measure_cloth.h"

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <map>

namespace rapport {
namespace {

/// Fibres and the direction that their light comes from.
struct Subject {
    std::vector<kernel::FibreTracer> realisations;
    std::vector<FibreOptics> optics;
    IncidentDirection incident;
    Colourways colourways{};

    BsdfTable measured(double accuracy, uint64_t seed, uint64_t max_paths = 0) const {
        BsdfTable table = make_partial_table(Bands{}, {incident});
        measure(realisations, optics, {.accuracy = accuracy, .max_paths = max_paths, .seed = seed},
                table, {}, {}, colourways);
        return table;
    }
};

std::vector<kernel::FibreTracer> only(const kernel::FibreAssembly& assembly) {
    std::vector<kernel::FibreTracer> tracers;
    tracers.emplace_back(assembly);
    return tracers;
}

Subject stack() {
    return {only(tests::fibre_stack(2, 12, 4.6, 2)),
            {{1.53, {0.001, 0.02, 0.1}, 0}},
            {Side::front, radians(35.0), radians(25.0)}};
}

Subject cloth_of(const std::string& name, Side side, double theta, double phi) {
    const Cloth cloth = read_cloth(RAPPORT_SOURCE_DIR "/scenes/cloths/" + name + ".toml");
    std::vector<kernel::FibreTracer> tracers = only(build_micro_element(cloth, {}).fibres);
    std::vector<FibreOptics> optics =
        cloth_optics(cloth, tracers[0], {.colour_paths = 1 << 12}).fibres;
    return {std::move(tracers), std::move(optics), {side, radians(theta), radians(phi)}};
}

/// A plain weave whose few fibres wander, so that no two of its cells are alike.
Subject random_cloth(uint64_t seed, int realisations) {
    YarnSpec yarn = tests::loose_yarn();
    yarn.irregularity = {.migration_um = 5, .deviation_degrees = 6};
    const Cloth cloth = tests::cloth_of(named_weave("plain"), yarn, yarn);
    return {build_realisations(cloth, {.max_turn_degrees = 4, .seed = seed}, realisations).tracers,
            tests::clear_fibres(),
            {Side::front, radians(35.0), radians(25.0)}};
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

/// What was claimed of the squared error, and what it really was, over independent runs.
struct Claims {
    Moments claimed, actual;

    void expect_honest(const std::string& of) const {
        const double ratio = std::sqrt(claimed.mean() / actual.mean());
        const double sigma =
            0.5 * std::hypot(claimed.error() / claimed.mean(), actual.error() / actual.mean());
        fmt::print("{}: claimed {:.4f}, true {:.4f}: ratio {:.4f} ± {:.4f} of {} runs\n", of,
                   std::sqrt(claimed.mean()), std::sqrt(actual.mean()), ratio, sigma, claimed.n);
        // Few seeds tell no ratio to 5 %: of them only what chance cannot have done is told.
        const double bound = tests::long_run() ? 0.05 : 3.5 * sigma;
        EXPECT_NEAR(ratio, 1, bound) << of;
        EXPECT_GT(std::abs(ratio / (tests::long_run() ? 1.1 : 1.2) - 1), bound)
            << of << ": an error claimed too small would pass";
    }
};

/// The claimed error against a long reference, over many independent runs that each stopped where
/// their own pilot and paths told them to; in the subject's own dyes and in all of its colourways.
void expect_honest(const Subject& subject, double asked, int seeds, uint64_t reference_paths) {
    const BsdfTable reference = subject.measured(1e-6, 12345, reference_paths);
    std::vector<std::string> dyes{""};
    for (const auto& [name, absorption] : subject.colourways)
        dyes.push_back(name);
    std::map<std::string, Claims> claims;
    std::map<std::string, Moments> reflected;
    int missed = 0;
    for (int seed = 0; seed < seeds; ++seed) {
        const BsdfTable table = subject.measured(asked, seed);
        missed += table.largest_accuracy() > asked;
        for (const std::string& name : dyes) {
            const BsdfTable own = table.in_colourway(name, ""),
                            expected = reference.in_colourway(name, "");
            claims[name].claimed.add(square(own.accuracy[0]));
            claims[name].actual.add(squared_error(own, expected) - square(expected.accuracy[0]));
            reflected[name].add(own.reflectance(0)[0]);
        }
    }
    EXPECT_EQ(missed, 0) << "runs that ended above the accuracy asked for";
    for (const std::string& name : dyes) {
        claims[name].expect_honest(name.empty() ? "own dyes" : name);
        // Paths added where ε was too large hardly bias the mean.
        const double r = reference.in_colourway(name, "").reflectance(0)[0];
        const double error = std::sqrt(r / static_cast<double>(reference_paths));
        EXPECT_NEAR(reflected[name].mean(), r, 3.5 * std::hypot(reflected[name].error(), error));
    }
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

/// The darkest decides how many paths there are; what is claimed of the others is theirs.
TEST(GoniophotometerError, OfEveryColourway) {
    Subject subject = stack();
    subject.colourways = {{"dark", {{0.1, 0.2, 0.3}}}, {"white", {{0, 0, 0}}}};
    expect_honest(subject, 1, tests::long_run() ? 400 : 60,
                  tests::long_run() ? 8'000'000 : 1'000'000);
}

/// ε is of the rays alone: against what the same realisations scatter.
TEST(GoniophotometerError, OfSeveralRealisations) {
    expect_honest(random_cloth(1, 4), 0.8, tests::long_run() ? 400 : 60,
                  tests::long_run() ? 8'000'000 : 400'000);
}

/// Against the cloth, which no four realisations are, a measurement is off by its ε and its
/// realisation error together; by its ε alone it would claim too little.
TEST(GoniophotometerError, OfFourRealisationsAgainstTheCloth) {
    const int cells = tests::long_run() ? 400 : 60, seeds = tests::long_run() ? 400 : 50;
    const BsdfTable cloth = random_cloth(12345, cells).measured(1e-6, 1, 8'000 * cells);
    const double known = square(cloth.accuracy[0]) + square(cloth.realisation_error[0]);
    Claims both;
    double noise = 0;
    for (int seed = 0; seed < seeds; ++seed) {
        const BsdfTable table = random_cloth(seed, 4).measured(0.5, seed);
        both.claimed.add(square(table.accuracy[0]) + square(table.realisation_error[0]));
        both.actual.add(squared_error(table, cloth) - known);
        noise += square(table.accuracy[0]) / seeds;
    }
    both.expect_honest("against the cloth");
    EXPECT_LT(noise, 0.7 * both.actual.mean());
}

TEST(GoniophotometerError, FallsWithTheRootOfThePaths) {
    const Subject subject = stack();
    const BsdfTable few = subject.measured(1e-6, 1, 10'000),
                    many = subject.measured(1e-6, 2, 160'000);
    EXPECT_NEAR(few.accuracy[0] / many.accuracy[0], 4, 0.2);
}

} // namespace
} // namespace rapport
