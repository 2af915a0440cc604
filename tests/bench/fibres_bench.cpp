#include "renderer/integrator/path_tracer.h"
#include "renderer/scene/shape/fibre_swatch.h"
#include "tests/support/swatch.h"
#include "vgsp/measure_cloth.h"

#include <benchmark/benchmark.h>
#include <chrono>

// A swatch seen from afar as explicit fibres, and by its table, under discs of light of several
// sizes: the time that each takes to a standard error of 1 % of the mean, on all threads.

namespace rapport {
namespace {

const Cloth& cloth() {
    static const Cloth cloth = read_cloth(RAPPORT_SOURCE_DIR "/scenes/cloths/viscose-satin.toml");
    return cloth;
}

Surface as_fibres() {
    static const auto swatch =
        std::make_shared<const FibreSwatch>(cloth(), glm::dvec2(3e5), std::string());
    return tests::fibre_surface(swatch);
}

Surface as_table() {
    static const auto material = [] {
        MeasureOptions options;
        options.goniophotometer.max_paths = 2000;
        return tests::cloth_of(std::make_shared<const TableBsdf>(
            measure_cloth(cloth(), options).table, "swatch.bsdf"));
    }();
    return tests::surface(tests::level_square(0.15f, 0), material);
}

void far_view(benchmark::State& state, Surface (*make_swatch)(), int samples) {
    const Surface swatch = make_swatch();
    const double half_angle = state.range(0) * tests::kDegree;
    const glm::dvec3 eye = spherical_direction(40 * tests::kDegree, 200 * tests::kDegree);
    const glm::dvec3 light = spherical_direction(30 * tests::kDegree, 40 * tests::kDegree);
    double seconds = 0, relative_variance = 0;
    for ([[maybe_unused]] auto _ : state) {
        const auto start = std::chrono::steady_clock::now();
        const tests::Estimate seen =
            tests::seen_under_disc(swatch, eye, light, 0.03f, samples, 1000, half_angle);
        seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
        relative_variance = seen.variance / square(seen.mean);
    }
    state.counters["seconds_to_1_percent"] = seconds * relative_variance / square(0.01);
}

void half_angles(benchmark::internal::Benchmark* bench) {
    for (const int degrees : {2, 5, 15, 40})
        bench->Arg(degrees)->Iterations(1)->Unit(benchmark::kSecond);
}
BENCHMARK_CAPTURE(far_view, fibres, as_fibres, 4000)->Apply(half_angles);
BENCHMARK_CAPTURE(far_view, table, as_table, 4000)->Apply(half_angles);

} // namespace
} // namespace rapport

BENCHMARK_MAIN();
