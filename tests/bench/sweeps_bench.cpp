#include "vgsp/micro_element.h"
#include "vgsp/plane_scan.h"

#include "tests/support/highlights.h"
#include "tests/support/large_draft.h"
#include "tests/support/mirror_images.h"
#include "tests/support/peak_memory.h"
#include "tests/support/sheared_cloth.h"
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

void shares_rows(const char* sweep, double parameter, const tests::Shares& shares) {
    row(sweep, "reflected", parameter, shares.reflected, error_of(shares.reflected, shares));
    row(sweep, "transmitted", parameter, shares.transmitted, error_of(shares.transmitted, shares));
    row(sweep, "unscattered", parameter, shares.unscattered, error_of(shares.unscattered, shares));
}

/// How far one share is from the reference.
void difference_row(const char* sweep, const char* curve, double parameter,
                    double tests::Shares::*share, const tests::Shares& shares,
                    const tests::Shares& reference) {
    row(sweep, curve, parameter, shares.*share - reference.*share,
        std::hypot(error_of(shares.*share, shares), error_of(reference.*share, reference)));
}

/// What the tests of tests/stability allow with so many paths, to both sides.
void bound_row(const char* sweep, double parameter, const tests::Shares& shares,
               const tests::Shares& reference, double allowed = 0) {
    row(sweep, "bound", parameter, tests::noise_of_difference(shares, reference) + allowed, 0);
}

void difference_rows(const char* sweep, double parameter, const tests::Shares& shares,
                     const tests::Shares& reference) {
    using tests::Shares;
    difference_row(sweep, "reflected", parameter, &Shares::reflected, shares, reference);
    difference_row(sweep, "transmitted", parameter, &Shares::transmitted, shares, reference);
    difference_row(sweep, "unscattered", parameter, &Shares::unscattered, shares, reference);
    bound_row(sweep, parameter, shares, reference);
}

tests::Shares clear(const kernel::FibreAssembly& assembly, const IncidentDirection& incident,
                    uint64_t seed = 0) {
    return tests::measure_shares(assembly, kClear, incident, {.paths = kPaths, .seed = seed});
}

/// Drafts that repeat nowhere. Ever larger ones, in a process that has held nothing else, for the
/// most memory that it has held is theirs.
void draft() {
    const double before = tests::peak_memory();
    for (const int size : {100, 150, 200, 300, 400, 600}) {
        const MicroElement element = build_micro_element(tests::monofilament_cloth(size));
        clear(element.fibres, kIncident);
        row("draft", "cylinders", size, 1e-6 * static_cast<double>(element.segments), 0);
        row("draft memory", "taken", size, (tests::peak_memory() - before) * 1e-9, 0);
        row("draft memory", "promised", size, tests::promised_memory(element) * 1e-9, 0);
        row("draft memory", "refused above", size, kMostMemory * 1e-9, 0);
    }
}

/// Against every disk of parallel fibres asked in double precision, as are absorption, refractive
/// index and overlap.
void incidence() {
    const tests::ParallelFibres fibres = tests::parallel_fibres();
    for (const double elevation : {90.0, 60.0, 40.0, 20.0, 10.0, 5.0, 2.0, 1.0, 0.5, 0.2, 0.1}) {
        const double theta = radians(90 - elevation);
        const tests::Shares shares = clear(fibres.assembly(), {Side::front, theta, 0});
        shares_rows("incidence", elevation, shares);
        difference_rows("incidence error", elevation, shares,
                        tests::UnionOfDisks(fibres).shares(theta, kPaths));
    }
}

void optics(const char* sweep, double parameter, double index, double absorption) {
    const tests::ParallelFibres fibres = tests::parallel_fibres();
    const tests::Shares shares =
        tests::measure_shares(fibres.assembly(), {index, {absorption}, 0},
                              {Side::front, kIncident.theta, 0}, {.paths = kPaths});
    shares_rows(sweep, parameter, shares);
    difference_rows((std::string(sweep) + " error").c_str(), parameter, shares,
                    tests::UnionOfDisks(fibres, index, absorption).shares(kIncident.theta, kPaths));
}

void absorption() {
    for (double sigma = 1e-7; sigma < 1e7; sigma *= 10)
        optics("absorption", sigma, 1.53, sigma);
}

void index() {
    for (const double over_one :
         {1e-9, 1e-7, 1e-5, 1e-4, 1e-3, 1e-2, 0.1, 0.3, 0.53, 1.0, 1.5, 3.0})
        optics("index", over_one, 1 + over_one, 0);
}

void overlap() {
    constexpr double kTheta = radians(25.0);
    const auto against_glass = [](const char* sweep, double overlap) {
        const tests::ParallelFibres fibres = tests::fibre_pair(overlap);
        const tests::Shares rule = clear(fibres.assembly(), {Side::front, kTheta, 0});
        const tests::Shares body = tests::UnionOfDisks(fibres).shares(kTheta, kPaths);
        difference_row(sweep, "reflected", overlap, &tests::Shares::reflected, rule, body);
        bound_row(sweep, overlap, rule, body, tests::overlap_error(overlap));
        return std::pair(rule.reflected, body.reflected);
    };
    for (double overlap = 0; overlap < 0.51; overlap += 0.025) {
        const auto [rule, body] = against_glass("overlap error", overlap);
        row("overlap", "the paper's shift rule", overlap, rule, 0);
        row("overlap", "one body of glass", overlap, body, 0);
    }
    for (const double overlap : {-1e-1, -1e-2, -1e-3, -1e-4, -1e-6, -1e-9, -1e-12, 0.0, 1e-12, 1e-9,
                                 1e-6, 1e-4, 1e-3, 1e-2, 1e-1})
        against_glass("touching", overlap);
}

/// Against fibres cut four times as finely.
void twist() {
    for (double tilt = 0; tilt < 46; tilt += 5) {
        const auto cut = [&](double max_turn_degrees) {
            return clear(build_micro_element(tests::tilted_cloth(radians(tilt)),
                                             {.max_turn_degrees = max_turn_degrees})
                             .fibres,
                         kIncident);
        };
        const tests::Shares shares = cut(1);
        shares_rows("twist", tilt, shares);
        difference_rows("twist error", tilt, shares, cut(0.25));
    }
}

/// Beams beside a special direction, against the special one.
void beam() {
    const auto beside = [](const char* curve, const kernel::FibreAssembly& fibres, double theta) {
        const tests::Shares special = clear(fibres, {Side::front, theta, 0});
        for (const double angle : {1e-15, 1e-12, 1e-9, 1e-7, 1e-6, 1e-5, 1e-4, 1e-3}) {
            const tests::Shares shares = clear(fibres, {Side::front, theta + angle, 0}, 1);
            difference_row("beam", curve, angle, &tests::Shares::reflected, shares, special);
            bound_row("beam", angle, shares, special);
        }
    };
    beside("along a fibre", tests::zigzag(), radians(45.0));
    beside("normal", tests::winding_fibres(), 0);
    const kernel::FibreTracer across(tests::fibre_stack(1, 12, 4.6, 2));
    for (const double angle : {1e-15, 1e-12, 1e-9, 1e-7, 1e-6, 1e-5, 1e-4, 1e-3}) {
        const BsdfTable table = tests::measured(across, tests::clear_fibres(),
                                                {{Side::front, radians(30.0), angle}}, kPaths);
        row("beam", "at a bin's edge: in other bins", angle, tests::share_off_plane(table, 0), 0);
    }
}

void cell() {
    const tests::Shares reference = clear(tests::fibre_stack(2, 12, 4.6, 1), kIncident);
    for (const double ratio : {1e-1, 3e-2, 1e-2, 3e-3, 1e-3, 3e-4, 1e-4})
        difference_rows(
            "cell", ratio,
            clear(tests::fibre_stack(2, 12, 4.6, static_cast<int>(std::round(9.2 / 12 / ratio))),
                  kIncident, 1),
            reference);
}

void scale() {
    const tests::Shares reference = clear(tests::winding_fibres(), kIncident);
    for (const double factor : {1e-3, 1e-2, 1e-1, 1e0, 1e1, 1e2, 1e3})
        difference_rows("scale", factor,
                        clear(tests::scaled(tests::winding_fibres(), factor), kIncident, 1),
                        reference);
    for (const auto& [curve, way] :
         {std::pair("moved along z", glm::dvec3(0, 0, 1)), {"moved along x", glm::dvec3(1, 0, 0)}})
        for (const double offset : {1e0, 1e1, 1e2, 1e3, 1e4, 1e5, 1e6}) {
            const tests::Shares moved = clear(tests::winding_fibres(offset * way), kIncident, 1);
            difference_row("offset", curve, offset, &tests::Shares::reflected, moved, reference);
            bound_row("offset", offset, moved, reference);
        }
}

void depth() {
    for (int cap = 8; cap <= 4096; cap *= 2) {
        const tests::Shares shares =
            tests::measure_shares(tests::fibre_stack(4, 12, 4.6, 2), kClear, kIncident,
                                  {.paths = kPaths, .max_events = cap});
        row("depth", "capped share", cap, shares.capped, error_of(shares.capped, shares));
    }
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

/// How far cells of so many repeats scatter from one of 26, whose twist is not rounded; what theirs
/// is rounded by goes to standard error.
void sides() {
    const std::vector<IncidentDirection> incident{kIncident};
    for (const double off : {0.0, 1.0 / 52}) {
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
            row("sides", off == 0 ? "twist that closes in a repeat" : "twist 1.9 % from closing",
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
    constexpr std::pair<std::string_view, void (*)()> kSweeps[]{{"draft", rapport::draft},
                                                                {"incidence", rapport::incidence},
                                                                {"absorption", rapport::absorption},
                                                                {"index", rapport::index},
                                                                {"overlap", rapport::overlap},
                                                                {"twist", rapport::twist},
                                                                {"beam", rapport::beam},
                                                                {"cell", rapport::cell},
                                                                {"scale", rapport::scale},
                                                                {"depth", rapport::depth},
                                                                {"segments", rapport::segments},
                                                                {"sides", rapport::sides},
                                                                {"highlights", rapport::highlights},
                                                                {"shear", rapport::shear}};
    std::puts("sweep,curve,parameter,value,error");
    for (const auto& [name, sweep] : kSweeps)
        if (argc == 1 || std::find(argv + 1, argv + argc, name) != argv + argc)
            sweep();
}
