#include "renderer/core/parallel.h"
#include "renderer/core/warp.h"
#include "tests/support/long_run.h"
#include "vgsp/measure_cloth.h"
#include "vgsp/path_tally.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

// All shipped cloths in the light of a grey sky on either side: how much of it is lost on the way.

namespace rapport {
namespace {

struct Totals {
    double capped = 0, lost = 0; ///< light, in the mean over the bands
    GoniophotometerCounts counts;

    Totals& operator+=(const Totals& other) {
        capped += other.capped;
        lost += other.lost;
        counts += other.counts;
        return *this;
    }
};

IncidentDirection diffuse(CounterRng& rng) {
    const Side side = rng.uniform() < 0.5 ? Side::front : Side::back;
    const double x = rng.uniform(), y = rng.uniform();
    const glm::dvec3 w = square_to_cosine_hemisphere(glm::dvec2(x, y));
    return {side, std::acos(w.z), azimuth(w)};
}

Totals trace(const IncidentPathTracer& paths, uint64_t first, uint64_t count) {
    Totals totals;
    IncidentPath path;
    for (uint64_t k = first; k < first + count; ++k) {
        CounterRng rng(0, Purpose::test, 0, k);
        paths.trace(diffuse(rng), rng, path);
        const bool capped = path.fate == PathFate::capped;
        const bool lost = capped && path.light.events < static_cast<uint32_t>(paths.max_events);
        totals.counts += {1, path.light.events, path.light.overlaps, capped && !lost, lost};
        if (!capped)
            continue;
        double left = 0;
        for (size_t channel = 0; channel < paths.channels; ++channel)
            left += path.weight(channel) / static_cast<double>(paths.channels);
        (lost ? totals.lost : totals.capped) += left;
    }
    return totals;
}

/// Batch by batch, until there were so many events.
Totals trace_events(const IncidentPathTracer& paths, uint64_t events) {
    constexpr uint64_t kBatchPaths = 1024, kBatches = 16;
    Totals totals;
    while (totals.counts.events < events) {
        const uint64_t first = totals.counts.paths;
        std::vector<Totals> batches(kBatches);
        parallel_for(kBatches, [&](size_t i) {
            batches[i] = trace(paths, first + i * kBatchPaths, kBatchPaths);
        });
        for (const Totals& batch : batches)
            totals += batch;
    }
    return totals;
}

std::vector<std::filesystem::path> our_cloths() {
    std::vector<std::filesystem::path> files;
    for (const auto& file :
         std::filesystem::directory_iterator(RAPPORT_SOURCE_DIR "/scenes/cloths"))
        if (file.path().extension() == ".toml")
            files.push_back(file.path());
    std::ranges::sort(files);
    return files;
}

void report(const std::string& name, const Totals& totals) {
    const double paths = static_cast<double>(totals.counts.paths);
    fmt::print("{:20} {:.3g} events, {:.1f} a path, {:.1e} in overlaps; of the light {:.1e} "
               "capped, {:.1e} lost ({} and {} of {} paths)\n",
               name, static_cast<double>(totals.counts.events),
               static_cast<double>(totals.counts.events) / paths,
               static_cast<double>(totals.counts.overlaps) /
                   static_cast<double>(totals.counts.events),
               totals.capped / paths, totals.lost / paths, totals.counts.capped, totals.counts.lost,
               totals.counts.paths);
    std::fflush(stdout);
}

/// A thousand million events in the long run.
TEST(PathEvents, LoseNoLight) {
    const std::vector<std::filesystem::path> files = our_cloths();
    const uint64_t events = (tests::long_run() ? 1'000'000'000 : 3'000'000) / files.size() + 1;
    Totals all;
    for (const std::filesystem::path& file : files) {
        Cloth cloth = read_cloth(file);
        cloth.colourways.clear(); // would go the same ways
        const kernel::FibreTracer tracer(build_micro_element(cloth, {}).fibres);
        const GoniophotometerSettings settings{.colour_paths = 1 << 12};
        for (const std::vector<FibreMedium>& media : media_of_groups(
                 cloth_optics(cloth, tracer, settings).fibres, cloth.bands.count(), tracer)) {
            const Totals totals = trace_events(
                {tracer, media, media[0].absorption_per_um.size(), settings.max_events, true},
                events);
            report(file.stem(), totals);
            EXPECT_LE(totals.capped, 1e-3 * static_cast<double>(totals.counts.paths)) << file;
            all += totals;
        }
    }
    report("all", all);
    EXPECT_GE(all.counts.events, events * files.size());
    EXPECT_LE(static_cast<double>(all.counts.lost), 1e-5 * static_cast<double>(all.counts.paths));
}

} // namespace
} // namespace rapport
