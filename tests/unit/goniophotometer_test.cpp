#include "vgsp/goniophotometer.h"

#include "renderer/core/error.h"
#include "renderer/core/parallel.h"
#include "tests/support/fibre_assemblies.h"
#include "vgsp/colour_solver.h"
#include "vgsp/measure_cloth.h"

#include <algorithm>
#include <chrono>
#include <gtest/gtest.h>
#include <thread>

namespace rapport {
namespace {

using kernel::FibreTracer;

BsdfTable two_directions() {
    return make_partial_table(Bands{}, {{Side::front, radians(30.0), radians(20.0)},
                                        {Side::back, radians(60.0), radians(200.0)}});
}

const std::vector<FibreOptics> kDyed{{1.53, {0, 0.01, 0.1}, 0.01}};

/// The five shares of one direction and band.
double total(const BsdfTable& table, size_t direction, size_t band) {
    const size_t i = direction * table.bands.count() + band;
    return table.reflectance(direction)[band] + table.transmittance(direction)[band] +
           table.unscattered[i] + table.absorbed[i] + table.capped[i];
}

TEST(FibreStep, RefractsBySnellAndReflectsByTheMirror) {
    const glm::dvec3 normal(0, 0, 1);
    for (const double degree : {0.0, 10.0, 45.0, 80.0, 89.999}) {
        const double theta = radians(degree);
        const glm::dvec3 d(std::sin(theta), 0, -std::cos(theta));
        const BoundaryEvent in = meet_boundary(d, normal, false, 1.53, 0.99999999);
        ASSERT_TRUE(in.transmitted);
        EXPECT_NEAR(in.direction.x * 1.53, d.x, 1e-14);
        EXPECT_NEAR(glm::length(in.direction), 1, 1e-14);
        EXPECT_LT(in.direction.z, 0);
        const BoundaryEvent mirror = meet_boundary(d, normal, false, 1.53, 0);
        EXPECT_FALSE(mirror.transmitted);
        EXPECT_NEAR(mirror.direction.z, -d.z, 1e-14);
        EXPECT_NEAR(mirror.direction.x, d.x, 1e-14);
        // Backwards, the refracted ray comes out where the first came in.
        const BoundaryEvent out = meet_boundary(-in.direction, normal, true, 1.53, 0.99999999);
        ASSERT_TRUE(out.transmitted);
        EXPECT_NEAR(glm::length(out.direction + d), 0, 1e-10);
    }
    // Beyond the critical angle, 40.8°, all is reflected.
    const glm::dvec3 d(std::sin(radians(41.0)), 0, std::cos(radians(41.0)));
    EXPECT_FALSE(meet_boundary(d, normal, true, 1.53, 0.99999999).transmitted);
    EXPECT_TRUE(meet_boundary(d, normal, true, 1.52, 0.99999999).transmitted);
}

TEST(FibreStep, IndexOneChangesNothing) {
    const glm::dvec3 d = glm::normalize(glm::dvec3(1, 2, -3));
    const BoundaryEvent event = meet_boundary(d, {0, 0, 1}, false, 1, 0);
    EXPECT_TRUE(event.transmitted);
    EXPECT_EQ(event.direction, d);
}

TEST(Goniophotometer, SameBytesForAnyNumberOfThreads) {
    const FibreTracer tracer(tests::winding_fibres());
    std::vector<BsdfTable> tables;
    for (const int threads : {1, 2, 3, 7}) {
        set_thread_count(threads);
        tables.push_back(two_directions());
        measure(tracer, kDyed, {.accuracy = 0.7, .seed = 5}, tables.back());
    }
    set_thread_count(0);
    for (const BsdfTable& table : tables) {
        EXPECT_EQ(table.intensity, tables[0].intensity);
        EXPECT_EQ(table.absorbed, tables[0].absorbed);
        EXPECT_EQ(table.unscattered, tables[0].unscattered);
        EXPECT_EQ(table.accuracy, tables[0].accuracy);
        EXPECT_EQ(table.paths, tables[0].paths);
    }
    BsdfTable other = two_directions();
    measure(tracer, kDyed, {.accuracy = 0.7, .seed = 6}, other);
    EXPECT_NE(other.intensity, tables[0].intensity);
}

TEST(Goniophotometer, AccountsForAllLight) {
    const FibreTracer tracer(tests::winding_fibres());
    BsdfTable table = two_directions();
    const GoniophotometerCounts counts =
        measure(tracer, kDyed, {.accuracy = 0.5, .max_events = 12}, table);
    EXPECT_GT(counts.capped, 0u);
    EXPECT_GT(counts.overlaps, 0u);
    EXPECT_EQ(counts.paths, table.paths[0] + table.paths[1]);
    for (size_t direction = 0; direction < 2; ++direction) {
        for (size_t band = 0; band < 3; ++band) {
            EXPECT_NEAR(total(table, direction, band), 1, 1e-5);
            EXPECT_GT(table.capped[direction * 3 + band], 0);
            EXPECT_GT(table.unscattered[direction * 3 + band], 0);
        }
        // More dye, more absorbed.
        EXPECT_LT(table.absorbed[direction * 3], table.absorbed[direction * 3 + 1]);
        EXPECT_LT(table.absorbed[direction * 3 + 1], table.absorbed[direction * 3 + 2]);
    }
}

TEST(Goniophotometer, ReachesTheAccuracyAskedForAndSaysHow) {
    const FibreTracer tracer(tests::reference_stack());
    BsdfTable table = two_directions();
    std::vector<double> fractions;
    double last_accuracy = 0;
    measure(tracer, kDyed, {.accuracy = 0.3}, table, [&](const GoniophotometerProgress& state) {
        fractions.push_back(state.fraction);
        last_accuracy = state.accuracy;
        EXPECT_GT(state.paths_per_second, 0);
        EXPECT_GE(state.seconds_left, 0);
    });
    EXPECT_EQ(fractions.back(), 1);
    EXPECT_TRUE(std::is_sorted(fractions.begin(), fractions.end()));
    EXPECT_FLOAT_EQ(last_accuracy, table.largest_accuracy());
    for (const float accuracy : table.accuracy) {
        EXPECT_LE(accuracy, 0.3f);
        EXPECT_GT(accuracy, 0.25f); // and not by much more work than that takes
    }
}

TEST(Goniophotometer, HonoursItsBounds) {
    const FibreTracer tracer(tests::reference_stack());
    for (const uint64_t most : {1u, 1000u, 1024u, 5000u}) {
        BsdfTable table = two_directions();
        measure(tracer, kDyed, {.accuracy = 1e-3, .max_paths = most}, table);
        EXPECT_EQ(table.paths, std::vector<uint64_t>(2, most));
    }
    BsdfTable table = two_directions();
    measure(tracer, kDyed, {.accuracy = 1e-4, .max_seconds = 0.3}, table);
    EXPECT_GT(table.paths[0], 0u);
    EXPECT_GT(table.accuracy[0], 1e-3); // for 1e-4 it would go on for hours
}

TEST(Goniophotometer, TellsOfItsPilotAndEndsItInTime) {
    const FibreTracer tracer(tests::reference_stack());
    BsdfTable table = make_partial_table(Bands{}, std::vector<IncidentDirection>(200));
    int pilots = 0;
    GoniophotometerCounts counts;
    // A slow machine is out of time before it begins.
    for (double most = 0.2; pilots == 0 && most < 20; most *= 2)
        counts = measure(tracer, kDyed, {.accuracy = 1e-4, .max_seconds = most}, table,
                         [&](const GoniophotometerProgress& state) {
                             if (!state.pilot)
                                 return;
                             ++pilots; // of some hundred times as many paths, if it is let
                             EXPECT_EQ(state.fraction, 0);
                             EXPECT_LE(state.seconds_left, most);
                             std::this_thread::sleep_for(std::chrono::duration<double>(0.5 * most));
                         });
    EXPECT_EQ(pilots, 1);
    EXPECT_TRUE(counts.out_of_time);
    EXPECT_GE(std::ranges::min(table.paths), 1024u);
}

TEST(Goniophotometer, RefusesWhatHasNoMeaning) {
    const FibreTracer tracer(tests::reference_stack());
    BsdfTable table = two_directions();
    const auto refused = [&](const FibreOptics& optics, const GoniophotometerSettings& settings) {
        EXPECT_THROW(measure(tracer, std::vector{optics}, settings, table), std::invalid_argument);
    };
    refused({0.9, {0, 0, 0}, 0}, {});
    refused({NAN, {0, 0, 0}, 0}, {});
    refused({1.5, {0, 0}, 0}, {});
    refused({{1.5, 1.6}, {0, 0, 0}, 0}, {});
    refused({{1.5, 1.6, 0.9}, {0, 0, 0}, 0}, {});
    refused({{1.5, 1.6, 1.7}, {0, 0}, 0}, {});
    refused({1.5, {0, 0, -1}, 0}, {});
    refused({1.5, {0, 0, 0}, 1.1}, {});
    refused({1.5, {0, 0, 0}, 0, -0.1}, {});
    refused({1.5, {0, 0, 0}, 0, NAN}, {});
    refused({1.5, {0, 0, 0}, 0}, {.accuracy = 0});
    refused({1.5, {0, 0, 0}, 0}, {.max_events = 0});
    EXPECT_THROW(measure(tracer, {}, {}, table), std::invalid_argument);
}

TEST(ColourSolver, ADyeGivesTheColourItWasSolvedFor) {
    const FibreTracer tracer(tests::reference_stack());
    const std::vector<FibreOptics> clear{{1.53, {0, 0, 0}, 0}};
    const ColourSolver solver(tracer, clear, {});
    EXPECT_EQ(solver.greatest_albedo(), 1);
    EXPECT_EQ(solver.absorption_for(1), 0);
    EXPECT_FALSE(solver.absorption_for(1.01));
    EXPECT_FALSE(solver.absorption_for(0.5 * solver.least_albedo()));
    double previous = 0;
    for (const double albedo : {0.9, 0.5, 0.2}) {
        const std::optional<double> absorption = solver.absorption_for(albedo);
        ASSERT_TRUE(absorption);
        EXPECT_NEAR(solver.albedo(*absorption), albedo, 1e-9);
        EXPECT_GT(*absorption, previous);
        previous = *absorption;
    }
    // Surface absorption keeps white out of reach, and is part of the albedo.
    const std::vector<FibreOptics> dull{{1.53, {0, 0, 0}, 0.02}};
    const ColourSolver dull_solver(tracer, dull, {});
    EXPECT_LT(dull_solver.greatest_albedo(), 0.9);
    EXPECT_FALSE(dull_solver.absorption_for(0.95));
}

YarnSpec thin_yarn() {
    YarnSpec yarn;
    yarn.fibres = 7;
    yarn.width_um = yarn.height_um = 60;
    yarn.fibre.diameter_um = 15;
    yarn.fibre.refractive_index = 1.53;
    return yarn;
}

Cloth thin_cloth() {
    Cloth cloth;
    cloth.name = "thin";
    cloth.draft = named_weave("plain");
    cloth.ends_per_cm = cloth.picks_per_cm = 60;
    cloth.warp = cloth.weft = thin_yarn();
    cloth.path = "thin.toml";
    cloth.source = "a thin cloth";
    return cloth;
}

/// One direction of light.
MeasureOptions coarse_options() {
    MeasureOptions options;
    options.goniophotometer.accuracy = 1;
    options.incidence = {{Side::front, 0.5, 0}};
    return options;
}

TEST(MeasureCloth, WritesWhatDecidesTheResult) {
    Cloth cloth = thin_cloth();
    cloth.warp.fibre.color = {0.8, 0.4, 0.2};
    cloth.weft.fibre.absorption_per_um = {0.001, 0.25, 0};
    MeasureOptions options = coarse_options();
    options.goniophotometer.seed = 3;
    const ClothMeasurement measured = measure_cloth(cloth, options);
    const auto& metadata = measured.table.metadata;
    EXPECT_TRUE(measured.table.partial());
    EXPECT_EQ(metadata.at("cloth"), "a thin cloth");
    EXPECT_EQ(metadata.at("seed"), "3");
    EXPECT_EQ(metadata.at("accuracy_asked"), "1");
    EXPECT_EQ(metadata.at("bands"), "R G B");
    EXPECT_EQ(metadata.at("weft_absorption_per_um"), "0.001 0.25 0");
    EXPECT_EQ(metadata.at("cloth_hash"), "fnv1a64:99096ad41300a32b");
    EXPECT_GT(measured.table.reflectance(0)[0], measured.table.reflectance(0)[1]);
    for (size_t band = 0; band < 3; ++band)
        EXPECT_NEAR(total(measured.table, 0, band), 1, 1e-5);
    EXPECT_EQ(measure_cloth(cloth, options).table.metadata, metadata);
}

TEST(MeasureCloth, AColourwaysColoursAreSolvedAsItsOwn) {
    Cloth cloth = thin_cloth();
    cloth.warp.fibre.color = {0.8, 0.4, 0.2};
    cloth.colourways["pale"]["warp"].color = {0.8, 0.8, 0.7};
    cloth.colourways["pale"]["weft"].absorption_per_um = {0.001, 0, 0};
    cloth.colourways["same"];
    const MeasureOptions options = coarse_options();
    const BsdfTable table = measure_cloth(cloth, options).table;
    const auto& metadata = table.metadata;
    EXPECT_EQ(metadata.at("colourway.same.warp_absorption_per_um"),
              metadata.at("warp_absorption_per_um"));
    EXPECT_EQ(metadata.at("colourway.pale.weft_absorption_per_um"), "0.001 0 0");
    EXPECT_EQ(table.colourways.at("same").intensity, table.intensity);
    cloth.warp.fibre.color = {0.8, 0.8, 0.7};
    EXPECT_EQ(measure_cloth(cloth, options).table.metadata.at("warp_absorption_per_um"),
              metadata.at("colourway.pale.warp_absorption_per_um"));
    cloth.colourways["pale"]["weft"] = {.absorption_per_um = {}, .color = {{0.5, 0.5, 0.0001}}};
    try {
        measure_cloth(cloth, options);
        FAIL() << "a black that no dye gives was accepted";
    } catch (const FileError& error) {
        EXPECT_EQ(error.place, "colourway.pale.weft.color");
    }
}

TEST(MeasureCloth, ChartsExitsAboutTheYarnsThatASideShows) {
    const auto charted = [](const Draft& draft, uint64_t seed) {
        Cloth cloth = thin_cloth();
        cloth.draft = draft;
        cloth.warp.width_um = cloth.weft.width_um = 120;
        MeasureOptions options = coarse_options();
        options.goniophotometer.seed = seed;
        return measure_cloth(cloth, options).table.exit_axis;
    };
    using Axes = std::array<ConeAxis, 2>;
    const Draft weft_satin = draft_from_rows({"10000", "00100", "00001", "01000", "00010"});
    for (const uint64_t seed : {0, 1, 2}) {
        EXPECT_EQ(charted(named_weave("plain"), seed), (Axes{ConeAxis::warp, ConeAxis::warp}));
        EXPECT_EQ(charted(named_weave("satin 5/2"), seed), (Axes{ConeAxis::warp, ConeAxis::weft}));
        EXPECT_EQ(charted(weft_satin, seed), (Axes{ConeAxis::weft, ConeAxis::warp}));
    }
}

TEST(MeasureCloth, NamesAColourThatCannotBeReached) {
    Cloth cloth = thin_cloth();
    cloth.weft.fibre.color = {0.5, 0.5, 0.0001};
    try {
        measure_cloth(cloth, coarse_options());
        FAIL() << "a black that no dye gives was accepted";
    } catch (const FileError& error) {
        EXPECT_EQ(error.path, "thin.toml");
        EXPECT_EQ(error.place, "weft.fibre.color");
        EXPECT_EQ(error.found, "0.0001");
    }
}

} // namespace
} // namespace rapport
