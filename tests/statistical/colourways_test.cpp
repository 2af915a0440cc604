#include "vgsp/goniophotometer.h"

#include "tests/support/fibre_assemblies.h"
#include "tests/support/long_run.h"

#include <gtest/gtest.h>

// Several dyes measured by the same paths against each measured by paths of its own.

namespace rapport {
namespace {

const uint64_t kPaths = tests::long_run() ? 1'000'000 : 100'000;
constexpr size_t kBands = 3;

/// Layers of fibres at right angles, of a kind each.
kernel::FibreAssembly two_kinds() {
    kernel::FibreAssembly assembly = tests::fibre_stack(4, 12, 4.6, 2);
    for (kernel::FibreChain& chain : assembly.chains)
        chain.kind = chain.period.x > 0 ? 0 : 1;
    return assembly;
}

using Dyes = std::vector<std::vector<double>>; ///< [kind][band]

std::vector<FibreOptics> optics(const Dyes& dyes) {
    return {{1.53, dyes[0], 1e-4}, {1.5, dyes[1], 0}};
}

BsdfTable measured(const Dyes& dyes, uint64_t seed, const Colourways& colourways = {}) {
    static const kernel::FibreTracer tracer(two_kinds());
    BsdfTable table = make_partial_table(Bands{}, {{Side::front, radians(40.0), radians(70.0)}});
    measure(tracer, optics(dyes), {.accuracy = 1e-6, .max_paths = kPaths, .seed = seed}, table, {},
            {}, colourways);
    return table;
}

const Dyes kUndyed{{0, 0, 0}, {0, 0, 0}};
/// So light that no path is ended by the roulette, whose numbers would be others.
const Colourways kLight{{"a", {{0, 1e-5, 2e-5}, {1e-6, 3e-5, 0}}},
                        {"b", {{2e-5, 2e-5, 2e-5}, {0, 0, 0}}},
                        {"c", {{0, 0, 0}, {2e-5, 1e-5, 5e-6}}}};
const Colourways kDark{{"a", {{0.01, 0.1, 0.3}, {0.02, 0.01, 0.05}}},
                       {"b", {{0.3, 0.3, 0.3}, {0.1, 0.2, 0.3}}}};

void expect_same(const std::vector<float>& a, const std::vector<float>& b) {
    ASSERT_EQ(a.size(), b.size());
    for (size_t i = 0; i < a.size(); ++i)
        ASSERT_NEAR(a[i], b[i], 2e-7 * (1 + std::abs(a[i])));
}

TEST(Colourways, OfOneTraceAreThoseOfSeparateTraces) {
    const BsdfTable together = measured(kUndyed, 1, kLight);
    for (const auto& [name, dyes] : kLight) {
        const BsdfTable alone = measured(dyes, 1), one = together.in_colourway(name, "");
        EXPECT_EQ(one.paths, alone.paths);
        expect_same(one.intensity, alone.intensity);
        expect_same(one.unscattered, alone.unscattered);
        expect_same(one.absorbed, alone.absorbed);
        expect_same(one.capped, alone.capped);
        EXPECT_NEAR(one.accuracy[0], alone.accuracy[0], 1e-6);
        EXPECT_NEAR(one.bin_error[0], alone.bin_error[0], 1e-5);
    }
    expect_same(together.intensity, measured(kUndyed, 1).intensity);
    // Exchanged, they would be told apart.
    for (const char* other : {"a", "c"})
        EXPECT_GT(std::abs(together.colourways.at(other).absorbed[0] -
                           together.colourways.at("b").absorbed[0]),
                  1e-4);
}

/// The largest difference of R or T in any band, in its standard errors: a path's weight lies in
/// [0, 1], so that its variance is at most mean·(1 − mean).
double largest_difference(const BsdfTable& a, const BsdfTable& b) {
    double largest = 0;
    for (const bool reflected : {true, false})
        for (size_t band = 0; band < kBands; ++band) {
            const double x = reflected ? a.reflectance(0)[band] : a.transmittance(0)[band];
            const double y = reflected ? b.reflectance(0)[band] : b.transmittance(0)[band];
            const double sigma = std::sqrt((x * (1 - x) + y * (1 - y)) / double(kPaths));
            largest = std::max(largest, std::abs(x - y) / sigma);
        }
    return largest;
}

/// Where the roulette ends paths, it does so by the brightest of all dyes.
TEST(Colourways, OfOneTraceAreThoseOfSeparateTracesWhereDark) {
    for (const Dyes& base : {kUndyed, kDark.at("b")}) {
        const BsdfTable together = measured(base, 1, kDark);
        for (const auto& [name, dyes] : kDark) {
            const BsdfTable one = together.in_colourway(name, "");
            EXPECT_LT(largest_difference(one, measured(dyes, 2)), 3.5) << name;
            // Wrong: the dyes of warp and weft exchanged.
            EXPECT_GT(largest_difference(one, measured({dyes[1], dyes[0]}, 2)), 10) << name;
        }
    }
}

TEST(Colourways, AllReachTheAccuracyAskedFor) {
    const kernel::FibreTracer tracer(two_kinds());
    BsdfTable table = make_partial_table(Bands{}, {{Side::front, 0.5, 0}, {Side::back, 1, 2}});
    double told = 0;
    measure(
        tracer, optics(kUndyed), {.accuracy = 0.5}, table,
        [&](const GoniophotometerProgress& progress) { told = progress.accuracy; }, {}, kDark);
    float largest = 0;
    for (const auto& [name, scattering] : table.colourways)
        for (size_t d = 0; d < 2; ++d) {
            EXPECT_LE(scattering.accuracy[d], 0.5f);
            EXPECT_LT(table.accuracy[d], scattering.accuracy[d]); // a dark dye is noisier
            largest = std::max(largest, scattering.accuracy[d]);
        }
    EXPECT_GT(largest, 0.4f); // and not by much more work than that takes
    EXPECT_EQ(table.largest_accuracy(), largest);
    EXPECT_FLOAT_EQ(told, largest);
}

TEST(Colourways, WithoutADyeForEachKindAreRefused) {
    EXPECT_THROW(measured(kUndyed, 1, {{"a", {{0, 0, 0}}}}), std::invalid_argument);
    EXPECT_THROW(measured(kUndyed, 1, {{"a", {{0, 0, 0}, {0, 0}}}}), std::invalid_argument);
    EXPECT_THROW(measured(kUndyed, 1, {{"a", {{0, 0, 0}, {0, 0, -1}}}}), std::invalid_argument);
}

} // namespace
} // namespace rapport
