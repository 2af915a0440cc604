#include "vgsp/goniophotometer.h"

#include "tests/support/fibre_assemblies.h"
#include "tests/support/long_run.h"

#include <gtest/gtest.h>

namespace rapport {
namespace {

// The reference: an infinite stack of 16 crossed layers, light from θ = 30°, φ = 20°, traced with
// 4·10⁷ paths in double precision by other means.
constexpr double kReflectance = 0.6872, kTransmittance = 0.3128, kReferenceError = 0.0001;

const uint64_t kPaths = tests::long_run() ? 4'000'000 : 1'000'000;

struct Shares {
    double reflectance, transmittance, sigma;
    GoniophotometerCounts counts;
};

Shares measure_stack(const kernel::FibreAssembly& stack, double index, uint64_t paths) {
    const kernel::FibreTracer tracer(stack);
    BsdfTable table = make_partial_table(Bands{}, {{Side::front, radians(30.0), radians(20.0)}});
    const GoniophotometerCounts counts =
        measure(tracer, std::vector<FibreOptics>{{index, {0, 0, 0}, 0}},
                {.accuracy = 1e-6, .max_paths = paths, .max_events = 1 << 20}, table);
    const double r = table.reflectance(0)[0];
    return {r, table.transmittance(0)[0], std::sqrt(r * (1 - r) / paths), counts};
}

TEST(FibreStack, ReflectsAndTransmitsAsTheReference) {
    const Shares shares = measure_stack(tests::reference_stack(), 1.53, kPaths);
    const double allowed = 3 * std::hypot(shares.sigma, kReferenceError);
    EXPECT_NEAR(shares.reflectance, kReflectance, allowed);
    EXPECT_NEAR(shares.transmittance, kTransmittance, allowed);
    EXPECT_NEAR(shares.reflectance + shares.transmittance, 1, 1e-5);
    EXPECT_EQ(shares.counts.capped, 0u);
    EXPECT_EQ(shares.counts.overlaps, 0u);
    EXPECT_NEAR(double(shares.counts.events) / shares.counts.paths, 47.9, 0.5);
}

TEST(FibreStack, AnotherIndexIsToldApart) {
    const Shares shares = measure_stack(tests::reference_stack(), 1.54, kPaths / 4);
    EXPECT_GT(std::abs(shares.reflectance - kReflectance),
              3 * std::hypot(shares.sigma, kReferenceError));
}

TEST(FibreStack, AnyCellOfTheSameStackMeasuresTheSame) {
    const Shares one = measure_stack(tests::reference_stack(1), 1.53, kPaths / 4);
    EXPECT_NEAR(one.reflectance, kReflectance, 3 * std::hypot(one.sigma, kReferenceError));
}

} // namespace
} // namespace rapport
