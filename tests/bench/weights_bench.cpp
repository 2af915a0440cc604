#include "materials/table/table_bsdf.h"
#include "renderer/core/rng.h"

#include <algorithm>
#include <cstdio>
#include <exception>

// The largest sampling weight of tables, band mean over the albedo's, and the same with the density
// of evaluation in the sampled direction in place of the sample's own: no fireflies where it is 1.
//     for cloth in scenes/cloths/*.toml; do
//         build/tests/rapport vgsp $cloth --max-rays 300 --quiet -o $(basename $cloth .toml).bsdf;
//         done
//     build/tests/tests/weights_bench *.bsdf
// Over a million samples a table: eyes over the whole sphere.

namespace rapport {
namespace {

float sum(const Rgb& c) { return c.r + c.g + c.b; }

void run(const char* path) {
    const TableBsdf bsdf(read_table(path), path);
    CounterRng rng(1, Purpose::test, 0, 0);
    float by_sample = 0, least = 2;
    std::vector<float> by_evaluation;
    for (int i = 0; i < 1'000'000; ++i) {
        const glm::vec3 eye =
            spherical_direction(std::acos(1 - 2 * rng.uniform_float()),
                                static_cast<float>(2 * kPi) * rng.uniform_float());
        const float choice = rng.uniform_float();
        const auto sample = bsdf.sample(eye, choice, {rng.uniform_float(), rng.uniform_float()});
        if (!sample)
            continue;
        const float relative = sum(sample->weight) / sum(bsdf.albedo(eye));
        by_sample = std::max(by_sample, relative);
        least = std::min(least, relative);
        by_evaluation.push_back(sample->pdf / bsdf.pdf(eye, sample->light) * relative);
    }
    std::ranges::sort(by_evaluation);
    const auto quantile = [&](double q) {
        return by_evaluation[static_cast<size_t>(q * (by_evaluation.size() - 1))];
    };
    std::printf(
        "%s: weight over albedo %.7f to %.7f; by the density of evaluation, 99.99 %% of the "
        "samples %.6f to %.6f, largest %.3f\n",
        path, least, by_sample, quantile(0.5e-4), quantile(1 - 0.5e-4), quantile(1));
    std::fflush(stdout);
}

} // namespace
} // namespace rapport

int main(int count, char** arguments) {
    try {
        for (int i = 1; i < count; ++i)
            rapport::run(arguments[i]);
    } catch (const std::exception& error) {
        std::fprintf(stderr, "weights_bench: %s\n", error.what());
        return 2;
    }
}
