#include "vgsp/fibre_step.h"

#include "renderer/core/parallel.h"
#include "tests/support/fibre_assemblies.h"
#include "tests/support/long_run.h"

#include <gtest/gtest.h>

// One smooth cylinder against its closed form (Marschner et al. 2003, in the far field and with
// Fresnel's equations averaged over polarisation at each event, as the tracer does it): light at
// inclination θ to the plane across the axis and offset h ∈ (−1, 1) from it enters at γi, sin γi =
// h, and runs at γt, sin γt = h/n′, n′ = √(n² − sin²θ)/cosθ. What leaves after p passages inside
// has turned to φ_p = 2pγt − 2γi + pπ about the axis, from where it came, on the same cone, and
// carries A_0 = F, A_p = (1 − F)² F^(p−1) T^p, T = exp(−σ·2r·cosγt/cosθt).

namespace rapport {
namespace {

constexpr int kLobes = 4; ///< R, TT, TRT, TRRT …
constexpr int kBins = 36; ///< of |φ| over [0, π]
constexpr double kRadius = 6;

struct Scattering {
    std::vector<double> lobes = std::vector<double>(kLobes, 0.0);
    std::vector<double> lobes_variance = std::vector<double>(kLobes, 0.0);
    std::vector<double> azimuth = std::vector<double>(kBins, 0.0);
    std::vector<double> azimuth_variance = std::vector<double>(kBins, 0.0);
};

size_t azimuth_bin(double phi) {
    return std::min<size_t>(kBins - 1, static_cast<size_t>(std::abs(phi) / kPi * kBins));
}

/// The closed form, by the midpoint rule over h.
Scattering closed_form(double index, double inclination, double absorption) {
    constexpr int kOffsets = 100000;
    const double s = std::sin(inclination), c = std::cos(inclination);
    const double cos_inside = std::sqrt(1 - square(s / index));
    const double bravais = std::sqrt(index * index - s * s) / c;
    Scattering result;
    for (int i = 0; i < kOffsets; ++i) {
        const double h = 2 * (i + 0.5) / kOffsets - 1;
        const double gamma_i = std::asin(h), gamma_t = std::asin(h / bravais);
        const double fresnel = fresnel_dielectric(c * std::cos(gamma_i), 1 / index).reflectance;
        const double passage = std::exp(-absorption * 2 * kRadius * std::cos(gamma_t) / cos_inside);
        double share = fresnel;
        for (int p = 0; share > 1e-9; ++p) {
            const double phi = 2 * p * gamma_t - 2 * gamma_i + p * kPi;
            result.azimuth[azimuth_bin(std::remainder(phi, 2 * kPi))] += share / kOffsets;
            if (p < kLobes)
                result.lobes[p] += share / kOffsets;
            share = (p == 0 ? square(1 - fresnel) : share * fresnel) * passage;
        }
    }
    return result;
}

/// The same by tracing. The fibre lies along y; light comes from (0, sinθ, cosθ).
Scattering traced(double index, double inclination, double absorption, int paths) {
    const double width = 4000 * kRadius; // so wide that light does not reach the next fibre
    const kernel::FibreTracer tracer(tests::single_fibre(kRadius, width));
    const std::vector<FibreMedium> media =
        fibre_media(std::vector<FibreOptics>{{index, {absorption}, 0}}, 1, tracer);
    constexpr int kBatch = 4096;
    std::vector<Scattering> batches(paths / kBatch);
    parallel_for(batches.size(), [&](size_t batch) {
        FibreLight light;
        for (int i = 0; i < kBatch; ++i) {
            CounterRng rng(7, Purpose::test, batch, i);
            light = {.position = {width / 2 + kRadius * (2 * rng.uniform() - 1), 30, 100},
                     .direction = {0, -std::sin(inclination), -std::cos(inclination)},
                     .length = {0}};
            while (advance(tracer, media, light, rng) == FibreStep::event && light.events < 1000) {
            }
            EXPECT_NEAR(light.direction.y, -std::sin(inclination), 1e-12); // the cone, exactly
            const double weight = std::exp(-absorption * light.length[0]);
            Scattering& sums = batches[batch];
            if (light.events <= kLobes) {
                sums.lobes[light.events - 1] += weight;
                sums.lobes_variance[light.events - 1] += weight * weight;
            }
            const size_t bin = azimuth_bin(std::atan2(light.direction.x, light.direction.z));
            sums.azimuth[bin] += weight;
            sums.azimuth_variance[bin] += weight * weight;
        }
    });
    const double n = static_cast<double>(batches.size()) * kBatch;
    const auto reduce = [&](std::vector<double> Scattering::*sum,
                            std::vector<double> Scattering::*sum2, Scattering& result) {
        for (size_t i = 0; i < (result.*sum).size(); ++i) {
            for (const Scattering& batch : batches) {
                (result.*sum)[i] += (batch.*sum)[i] / n;
                (result.*sum2)[i] += (batch.*sum2)[i] / n;
            }
            (result.*sum2)[i] = ((result.*sum2)[i] - square((result.*sum)[i])) / n;
        }
    };
    Scattering result;
    reduce(&Scattering::lobes, &Scattering::lobes_variance, result);
    reduce(&Scattering::azimuth, &Scattering::azimuth_variance, result);
    return result;
}

/// Σ z² over the bins, less their number, in standard deviations of a χ² of that many.
double chi_square_excess(const Scattering& estimate, const Scattering& expected) {
    double sum = 0;
    for (int bin = 0; bin < kBins; ++bin)
        sum +=
            square(estimate.azimuth[bin] - expected.azimuth[bin]) / estimate.azimuth_variance[bin];
    return (sum - kBins) / std::sqrt(2.0 * kBins);
}

TEST(SingleFibre, ClosedFormHasTheKnownShares) {
    const Scattering normal = closed_form(1.55, 0, 0);
    EXPECT_NEAR(normal.lobes[0], 0.07496, 1e-5);
    EXPECT_NEAR(normal.lobes[1], 0.8618, 1e-4);
    EXPECT_NEAR(normal.lobes[2], 0.0557, 1e-4);
    EXPECT_NEAR(normal.lobes[3], 0.0056, 1e-4);
}

TEST(SingleFibre, SharesAndAzimuthsFollowTheClosedForm) {
    const int paths = tests::long_run() ? 1 << 22 : 1 << 16;
    for (const double inclination : {0.0, 30.0, 60.0})
        for (const double absorption : {0.0, 0.05}) {
            SCOPED_TRACE(testing::Message() << inclination << "°, σ " << absorption);
            const double theta = radians(inclination);
            const Scattering estimate = traced(1.55, theta, absorption, paths);
            const Scattering expected = closed_form(1.55, theta, absorption);
            for (int lobe = 0; lobe < kLobes; ++lobe)
                EXPECT_NEAR(estimate.lobes[lobe], expected.lobes[lobe],
                            3.5 * std::sqrt(estimate.lobes_variance[lobe]))
                    << "lobe " << lobe;
            EXPECT_LT(chi_square_excess(estimate, expected), 3.5);
            // The fibre next in index is told apart.
            EXPECT_GT(chi_square_excess(estimate, closed_form(1.58, theta, absorption)), 5);
        }
}

} // namespace
} // namespace rapport
