#include "vgsp/micro_element.h"
#include "vgsp/plane_scan.h"

#include "tests/support/highlights.h"
#include "tests/support/mirror_images.h"
#include "tests/support/sheared_cloth.h"
#include "tests/support/stability.h"
#include "tests/support/union_of_disks.h"

#include <cstdio>

// The sweeps of tests/stability as numbers for charts: lines of sweep, curve, parameter, value and
// its standard error. charts/sweeps.py draws them:
//
//   build/tests/tests/sweeps_bench | python3 tests/bench/charts/sweeps.py
//
// or those of the functions below that are named after it.

namespace rapport {
namespace {

constexpr uint64_t kPaths = 200'000;
const FibreOptics kClear{1.53, {0}, 0};
const IncidentDirection kIncident{Side::front, radians(30.0), radians(20.0)};

void row(const char* sweep, const char* curve, double parameter, double value, double error) {
    std::printf("%s,%s,%.9g,%.9g,%.3g\n", sweep, curve, parameter, value, error);
    std::fflush(stdout);
}

/// One standard error of a share.
double error_of(double share, const tests::Shares& shares) {
    return std::sqrt(std::max(share * (1 - share), 1 / shares.paths) / shares.paths);
}

void shares_row(const char* sweep, double parameter, const tests::Shares& shares) {
    row(sweep, "reflected", parameter, shares.reflected, error_of(shares.reflected, shares));
    row(sweep, "transmitted", parameter, shares.transmitted, error_of(shares.transmitted, shares));
    row(sweep, "unscattered", parameter, shares.unscattered, error_of(shares.unscattered, shares));
}

tests::Shares clear(const kernel::FibreAssembly& assembly, const IncidentDirection& incident,
                    uint64_t seed = 0) {
    return tests::measure_shares(assembly, kClear, incident, {.paths = kPaths, .seed = seed});
}

/// Each against the first assembly: how far R is off.
void difference_row(const char* sweep, const char* curve, double parameter,
                    const tests::Shares& shares, const tests::Shares& reference) {
    row(sweep, curve, parameter, shares.reflected - reference.reflected,
        std::hypot(error_of(shares.reflected, shares), error_of(reference.reflected, reference)));
}

void incidence() {
    for (const double elevation : {90.0, 60.0, 40.0, 20.0, 10.0, 5.0, 2.0, 1.0, 0.5, 0.2, 0.1})
        shares_row(
            "incidence", elevation,
            clear(tests::winding_fibres(), {Side::front, radians(90 - elevation), radians(37.0)}));
}

void overlap() {
    constexpr double kRadius = 5, kPeriod = 40, kTheta = radians(25.0), kTilt = radians(30.0);
    for (double overlap = 0; overlap < 0.51; overlap += 0.025) {
        const glm::dvec2 half =
            kRadius * (1 - overlap) * glm::dvec2(std::cos(kTilt), std::sin(kTilt));
        const std::vector<glm::dvec2> centres{glm::dvec2(kPeriod / 2, 0) - half,
                                              glm::dvec2(kPeriod / 2, 0) + half};
        kernel::FibreAssembly assembly{{kPeriod, 20}, {}};
        for (const glm::dvec2& centre : centres)
            assembly.chains.push_back({{{centre.x, 0, centre.y}}, {0, 20, 0}, kRadius, 0});
        const tests::Shares rule = clear(assembly, {Side::front, kTheta, 0});
        const double body = tests::UnionOfDisks(centres, kRadius, kPeriod, 1.53)
                                .reflectance(kTheta, static_cast<int>(kPaths));
        row("overlap", "the paper's shift rule", overlap, rule.reflected,
            error_of(rule.reflected, rule));
        row("overlap", "one body of glass", overlap, body, error_of(body, rule));
    }
}

void twist() {
    for (double tilt = 0; tilt < 46; tilt += 5) {
        YarnSpec yarn = tests::loose_yarn(90, 14);
        yarn.section = YarnSection::twisted;
        yarn.twist_per_m = 1e6 * std::tan(radians(tilt)) / (kPi * (90 - 14));
        const MicroElement element =
            build_micro_element(tests::cloth_of(named_weave("plain"), yarn, yarn, 45, 45));
        shares_row("twist", tilt, clear(element.fibres, kIncident));
    }
}

void cell() {
    const tests::Shares reference = clear(tests::fibre_stack(2, 12, 4.6, 1), kIncident);
    for (const double ratio : {1e-1, 3e-2, 1e-2, 3e-3, 1e-3, 3e-4, 1e-4})
        difference_row(
            "cell", "fibres of one size in a wider cell", ratio,
            clear(tests::fibre_stack(2, 12, 4.6, static_cast<int>(std::round(9.2 / 12 / ratio))),
                  kIncident, 1),
            reference);
}

void scale() {
    const tests::Shares reference = clear(tests::winding_fibres(), kIncident);
    for (const double factor : {1e-3, 1e-2, 1e-1, 1e0, 1e1, 1e2, 1e3}) {
        kernel::FibreAssembly assembly = tests::winding_fibres();
        assembly.cell *= factor;
        for (kernel::FibreChain& chain : assembly.chains) {
            for (glm::dvec3& point : chain.points)
                point *= factor;
            chain.period *= factor;
            chain.radius *= factor;
        }
        difference_row("scale", "the same in another unit", factor, clear(assembly, kIncident, 1),
                       reference);
    }
    for (const double offset : {1e0, 1e1, 1e2, 1e3, 1e4, 1e5, 1e6})
        difference_row("offset", "moved along z", offset,
                       clear(tests::winding_fibres({0, 0, offset}), kIncident, 1), reference);
    for (const double offset : {1e0, 1e1, 1e2, 1e3, 1e4, 1e5, 1e6})
        difference_row("offset", "moved along x", offset,
                       clear(tests::winding_fibres({offset, 0, 0}), kIncident, 1), reference);
}

void optics() {
    const kernel::FibreAssembly stack = tests::fibre_stack(4, 12, 4.6, 2);
    for (int cap = 8; cap <= 4096; cap *= 2) {
        const tests::Shares shares =
            tests::measure_shares(stack, kClear, kIncident, {.paths = kPaths, .max_events = cap});
        row("depth", "capped share", cap, shares.capped, error_of(shares.capped, shares));
    }
    for (double sigma = 1e-7; sigma < 1e7; sigma *= 10) {
        const tests::Shares shares =
            tests::measure_shares(stack, {1.53, {sigma}, 0}, kIncident, {.paths = kPaths});
        shares_row("absorption", sigma, shares);
        row("absorption", "absorbed", sigma, shares.absorbed, error_of(shares.absorbed, shares));
    }
    for (const double index : {1.0, 1.0001, 1.01, 1.1, 1.3, 1.5, 1.7, 2.0, 2.5, 3.0, 4.0})
        shares_row("index", index,
                   tests::measure_shares(stack, {index, {0}, 0}, kIncident, {.paths = kPaths}));
}

void segments() {
    constexpr int kMany = 6'000'000;
    const tests::MirrorImages limit = tests::mirror_images(0.25, true, kMany, 1);
    const auto chart = [&](const char* curve, const tests::MirrorImages& images) {
        for (int step = 0; step < tests::MirrorImages::kSteps; ++step)
            row("peaks", curve, degrees(tests::MirrorImages::angle(step)), images.density[step],
                images.error[step]);
    };
    chart("16° a segment; all alike", tests::mirror_images(16, false, kMany, 2));
    chart("1° a segment; dithered", tests::mirror_images(1, true, kMany, 3));
    chart("0.25° a segment; dithered", limit);
    for (const double turn : {16.0, 8.0, 4.0, 2.0, 1.0, 0.5})
        for (const bool dither : {false, true}) {
            const tests::MirrorImages images = tests::mirror_images(turn, dither, kMany, 4);
            row("segments", dither ? "dithered" : "all alike",
                static_cast<double>(images.segments) / images.fibres,
                tests::difference(images, limit), 0);
        }
}

/// How far cells of so many repeats scatter from a very long one; what their twist is rounded by
/// goes to standard error.
void sides() {
    const std::vector<IncidentDirection> incident{kIncident};
    for (const double off : {0.0, 0.0199}) {
        const Cloth cloth = tests::twisted_cloth(2, off);
        const auto measured = [&](int repeats) {
            const MicroElement element = build_micro_element(cloth, {.least_repeats = repeats});
            std::fprintf(stderr, "%d repeats: twist rounded by %+.4f\n", repeats,
                         element.twist_rounding_warp);
            return tests::measured(kernel::FibreTracer(element.fibres), tests::clear_fibres(),
                                   incident, 4 * kPaths, static_cast<uint64_t>(repeats));
        };
        const BsdfTable limit = measured(26);
        for (const int repeats : {1, 2, 4, 8, 16, 25})
            row("sides", off == 0 ? "twist that closes in a repeat" : "twist 2 % from closing",
                repeats, tests::departure(measured(repeats), limit, 0), 0);
    }
}

/// How far cloths that were sheared and measured anew scatter from what each rule makes of the
/// unsheared one, over six directions of light. Fibres are thinned to keep clear of each other.
void shear() {
    constexpr uint64_t kFewPaths = 50'000;
    const std::vector<IncidentDirection> incident{
        {Side::front, radians(20.0), radians(20.0)},  {Side::front, radians(50.0), radians(75.0)},
        {Side::front, radians(65.0), radians(130.0)}, {Side::front, radians(40.0), radians(165.0)},
        {Side::back, radians(30.0), radians(50.0)},   {Side::back, radians(60.0), radians(110.0)}};
    const auto chart = [&](const std::string& name,
                           const std::vector<std::pair<int, int>>& closures) {
        kernel::FibreAssembly fibres =
            build_micro_element(read_cloth(RAPPORT_SOURCE_DIR "/scenes/cloths/" + name + ".toml"))
                .fibres;
        for (kernel::FibreChain& chain : fibres.chains)
            chain.radius *= 0.85;
        const kernel::FibreTracer unsheared(fibres);
        for (const auto& [rows, columns] : closures) {
            const tests::ShearedCloth cloth = tests::sheared(fibres, rows, columns);
            const kernel::FibreTracer tracer(cloth.fibres);
            std::vector<tests::Departure> departures(tests::kShearRules.size());
            for (const IncidentDirection& direction : incident) {
                const tests::ExitCounts truth =
                    tests::sheared_exits(tracer, glm::dmat2(1), direction, kFewPaths, 1);
                for (size_t r = 0; r < departures.size(); ++r)
                    departures[r].add(
                        truth,
                        tests::sheared_exits(unsheared, tests::kShearRules[r].to_table(cloth.angle),
                                             direction, kFewPaths, 2),
                        direction, kFewPaths);
            }
            for (size_t r = 0; r < departures.size(); ++r)
                row("shear", (name + "; " + tests::kShearRules[r].name).c_str(),
                    degrees(cloth.angle), departures[r].value(), 0);
        }
    };
    chart("viscose-plain", {{4, 1}, {3, 1}});
    chart("viscose-satin", {{4, 1}, {2, 1}});
}

/// The scans of tests/statistical/highlights_test.cpp; "measured" rows tell angles only.
void highlights() {
    for (const auto& [file, measured] : {std::pair("silk-charmeuse", &tests::kSatinCharmeuse),
                                         {"silk-crepe-de-chine", &tests::kCrepeDeChine},
                                         {"linen", &tests::kLinen}}) {
        const Cloth cloth =
            read_cloth(std::string(RAPPORT_SOURCE_DIR "/scenes/cloths/") + file + ".toml");
        const PlaneScan scan = tests::mirror_scan(cloth, kPi / 2, 8'000'000);
        const std::vector<double> intensity = tests::smoothed(scan);
        for (int bin = 0; bin < PlaneScan::kAngles; ++bin)
            row("highlights", cloth.name.c_str(), degrees(PlaneScan::angle(bin)), intensity[bin],
                scan.mean_error[bin]);
        if (measured == &tests::kLinen)
            continue; // it has none
        for (const double inclination : measured->inclinations)
            for (const double side : {-1, 1})
                row("highlights", ("measured: " + std::string(measured->name)).c_str(),
                    side * measured->exit(inclination), 0, measured->narrowest());
    }
}

} // namespace
} // namespace rapport

int main(int argc, char** argv) {
    constexpr std::pair<std::string_view, void (*)()> kSweeps[]{
        {"incidence", rapport::incidence},   {"overlap", rapport::overlap},
        {"twist", rapport::twist},           {"cell", rapport::cell},
        {"scale", rapport::scale},           {"optics", rapport::optics},
        {"segments", rapport::segments},     {"sides", rapport::sides},
        {"highlights", rapport::highlights}, {"shear", rapport::shear}};
    std::puts("sweep,curve,parameter,value,error");
    for (const auto& [name, sweep] : kSweeps)
        if (argc == 1 || std::find(argv + 1, argv + argc, name) != argv + argc)
            sweep();
}
