#include "materials/table/table_bsdf.h"
#include "renderer/core/rng.h"
#include "tests/support/synthetic_tables.h"

#include <benchmark/benchmark.h>
#include <vector>

// Time of one look-up in a table of the full grid, over directions that change from call to call:
// about one direction (the nodes stay in the cache), or over the whole sphere (they do not); and of
// sampling meshes of more and more exits from few directions of incidence, which takes the
// logarithm of their number and what the cache makes of their memory.

namespace rapport {
namespace {

const TableBsdf& satin() {
    static const TableBsdf bsdf(tests::synthetic_table(tests::satin_intensity, 0.05), "");
    return bsdf;
}

struct Query {
    glm::vec3 eye, light;
    float choice;
    glm::vec2 u;
};

std::vector<Query> queries(bool whole_sphere) {
    CounterRng rng(1, Purpose::test, 0, 0);
    const auto uniform_direction = [&] {
        return spherical_direction(std::acos(1 - 2 * rng.uniform_float()),
                                   static_cast<float>(2 * kPi) * rng.uniform_float());
    };
    std::vector<Query> all(1 << 14);
    for (Query& query : all) {
        query.eye = uniform_direction();
        if (!whole_sphere)
            query.eye = glm::normalize(0.02f * query.eye + glm::vec3(0.6f, 0.2f, 0.6f));
        query.light = uniform_direction();
        query.choice = rng.uniform_float();
        query.u = {rng.uniform_float(), rng.uniform_float()};
    }
    return all;
}

template <class F> void run(benchmark::State& state, const F& call) {
    const std::vector<Query> all = queries(state.range(0));
    state.SetLabel(state.range(0) ? "whole sphere" : "one eye direction");
    const TableBsdf& bsdf = satin();
    size_t i = 0;
    for (auto _ : state) {
        call(bsdf, all[i]);
        i = (i + 1) % all.size();
    }
}

void eval_and_pdf(benchmark::State& state) {
    run(state, [](const TableBsdf& bsdf, const Query& q) {
        benchmark::DoNotOptimize(bsdf.eval_and_pdf(q.eye, q.light));
    });
}
BENCHMARK(eval_and_pdf)->Arg(0)->Arg(1);

void sample(benchmark::State& state) {
    run(state, [](const TableBsdf& bsdf, const Query& q) {
        benchmark::DoNotOptimize(bsdf.sample(q.eye, q.choice, q.u));
    });
}
BENCHMARK(sample)->Arg(0)->Arg(1);

void sample_of_mesh(benchmark::State& state) {
    BsdfTable table = tests::small_synthetic_table(tests::satin_intensity);
    table.exits = DirectionMesh(static_cast<int>(state.range(0)), static_cast<int>(state.range(1)));
    table.intensity.resize(table.directions() * 2 * table.exits.bins() * table.bands.count());
    CounterRng rng(2, Purpose::test, 0, 0);
    for (float& intensity : table.intensity)
        intensity = rng.uniform_float() / static_cast<float>(4 * kPi);
    const TableBsdf bsdf(std::move(table), "");
    const std::vector<Query> all = queries(false);
    size_t i = 0;
    for (auto _ : state) {
        benchmark::DoNotOptimize(bsdf.sample(all[i].eye, all[i].choice, all[i].u));
        i = (i + 1) % all.size();
    }
}
BENCHMARK(sample_of_mesh)
    ->ArgNames({"columns", "rows"})
    ->Args({24, 16})
    ->Args({48, 32})
    ->Args({96, 64})
    ->Args({192, 128})
    ->Args({384, 256});

} // namespace
} // namespace rapport

BENCHMARK_MAIN();
