#include "vgsp/goniophotometer.h"

#include "renderer/core/parallel.h"
#include "tests/support/fibre_assemblies.h"
#include "vgsp/micro_element.h"

#include <benchmark/benchmark.h>
#include <ctime>

// Binned paths per second of the goniophotometer for light from θ = 30°, φ = 20°, index 1.53, three
// bands without absorption; R and T go with the figures. Argument: threads. paths/cpu_s, per second
// of processor time of all threads together, holds on a busy machine too.

namespace rapport {
namespace {

void run(benchmark::State& state, const kernel::FibreAssembly& assembly,
         const std::vector<FibreOptics>& optics, const Colourways& colourways = {}) {
    constexpr uint64_t kPaths = 200'000;
    const kernel::FibreTracer tracer(assembly);
    set_thread_count(static_cast<int>(state.range(0)));
    BsdfTable table = make_partial_table(Bands{}, {{Side::front, radians(30.0), radians(20.0)}});
    uint64_t seed = 0, paths = 0, events = 0;
    const std::clock_t cpu_start = std::clock();
    for (auto _ : state) {
        const GoniophotometerCounts counts =
            measure(tracer, optics, {.accuracy = 1e-6, .max_paths = kPaths, .seed = seed++}, table,
                    {}, {}, colourways);
        paths += counts.paths;
        events += counts.events;
    }
    const double cpu_seconds = static_cast<double>(std::clock() - cpu_start) / CLOCKS_PER_SEC;
    set_thread_count(0);
    state.counters["paths/cpu_s"] = static_cast<double>(paths) / cpu_seconds;
    state.counters["paths/s"] =
        benchmark::Counter(static_cast<double>(paths), benchmark::Counter::kIsRate);
    state.counters["events/path"] = static_cast<double>(events) / static_cast<double>(paths);
    state.counters["R"] = table.reflectance(0)[0];
    state.counters["T"] = table.transmittance(0)[0];
}

void reference_stack(benchmark::State& state) {
    run(state, tests::reference_stack(), {{1.53, {0, 0, 0}, 0}});
}

YarnSpec filament_yarn() {
    YarnSpec yarn;
    yarn.fibres = 37;
    yarn.width_um = 120;
    yarn.height_um = 80;
    yarn.fibre.diameter_um = 11.9;
    yarn.fibre.refractive_index = 1.53;
    return yarn;
}

void plain_weave(benchmark::State& state, double roughness, int colourways) {
    Colourways dyes; // beside the undyed
    for (int i = 1; i < colourways; ++i)
        dyes[std::string(1, static_cast<char>('a' + i))] = {{1e-3 * i, 2e-3 * i, 5e-3 * i},
                                                            {3e-3 * i, 2e-3 * i, 1e-3 * i}};
    Cloth cloth;
    cloth.draft = named_weave("plain");
    cloth.ends_per_cm = cloth.picks_per_cm = 50;
    cloth.warp = cloth.weft = filament_yarn();
    run(state, build_micro_element(cloth).fibres,
        std::vector<FibreOptics>(2, {1.53, {0, 0, 0}, 0, roughness}), dyes);
}

void timed(benchmark::internal::Benchmark* each) {
    each->MeasureProcessCPUTime()->UseRealTime()->Unit(benchmark::kSecond)->Iterations(3);
}
BENCHMARK(reference_stack)->Arg(1)->Arg(2)->Apply(timed);
BENCHMARK_CAPTURE(plain_weave, smooth, 0.0, 1)->Arg(1)->Arg(2)->Apply(timed);
BENCHMARK_CAPTURE(plain_weave, rough, 0.1, 1)->Arg(1)->Apply(timed);
BENCHMARK_CAPTURE(plain_weave, eight_colourways, 0.0, 8)->Arg(1)->Apply(timed);

} // namespace
} // namespace rapport

BENCHMARK_MAIN();
