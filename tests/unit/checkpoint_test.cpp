#include "renderer/core/error.h"
#include "renderer/core/parallel.h"
#include "renderer/core/rng.h"
#include "tests/support/fibre_assemblies.h"
#include "tests/support/file_bytes.h"
#include "tests/support/run_program.h"
#include "tests/support/temporary_folder.h"
#include "vgsp/goniophotometer.h"

#include <algorithm>
#include <chrono>
#include <gtest/gtest.h>
#include <unistd.h>

namespace rapport {
namespace {

struct Interruption {};

class Checkpointed : public testing::Test {
  protected:
    Checkpointed() {
        tracers_.emplace_back(tests::fibre_stack(2, 12, 4.6, 2));
        tracers_.emplace_back(tests::fibre_stack(2, 12, 4.2, 2));
    }

    static BsdfTable empty_table() {
        BsdfTable table =
            make_partial_table(Bands{}, {{Side::front, 0.6, 0.4}, {Side::back, 0, 0}});
        table.metadata["cloth"] = "a stack";
        return table;
    }

    /// Measures until the callback has been told of `increments`, or to the end.
    BsdfTable run(int increments, bool resume, const BsdfTable& layout = empty_table(),
                  uint64_t max_paths = 0) {
        BsdfTable table = layout;
        table.metadata["max_paths"] = std::to_string(max_paths);
        increments_ = 0;
        counts_ = measure(tracers_, std::vector<FibreOptics>{{1.5, {0, 0.01, 0.1}, 0.01}},
                          {.accuracy = accuracy_, .max_paths = max_paths, .seed = 3}, table,
                          [&](const GoniophotometerProgress& state) {
                              if (state.pilot)
                                  return;
                              if (++increments_ == increments)
                                  throw Interruption();
                              EXPECT_GE(state.seconds_left, 0);
                              EXPECT_GT(state.paths_per_second, 0);
                          },
                          {folder_ / "table.part", resume}, {{"dark", {{0.1, 0.2, 0.3}}}});
        return table;
    }

    const tests::TemporaryFolder folder_;
    std::vector<kernel::FibreTracer> tracers_;
    double accuracy_ = 0.2;
    GoniophotometerCounts counts_;
    int increments_ = 0;
};

void expect_same_numbers(const BsdfTable& a, const BsdfTable& b) {
    EXPECT_EQ(a.intensity, b.intensity);
    EXPECT_EQ(a.unscattered, b.unscattered);
    EXPECT_EQ(a.absorbed, b.absorbed);
    EXPECT_EQ(a.capped, b.capped);
    EXPECT_EQ(a.lost, b.lost);
    EXPECT_EQ(a.paths, b.paths);
    EXPECT_EQ(a.accuracy, b.accuracy);
    EXPECT_EQ(a.bin_error, b.bin_error);
    EXPECT_EQ(a.realisation_error, b.realisation_error);
    ASSERT_EQ(a.colourways.size(), b.colourways.size());
    for (const auto& [name, scattering] : a.colourways) {
        EXPECT_EQ(scattering.intensity, b.colourways.at(name).intensity);
        EXPECT_EQ(scattering.absorbed, b.colourways.at(name).absorbed);
        EXPECT_EQ(scattering.accuracy, b.colourways.at(name).accuracy);
        EXPECT_EQ(scattering.realisation_error, b.colourways.at(name).realisation_error);
    }
}

TEST_F(Checkpointed, RunsThatAreInterruptedEndWithTheSameNumbers) {
    const BsdfTable uninterrupted = run(0, false);
    std::filesystem::remove(folder_ / "table.part");
    const int all = increments_;
    ASSERT_GE(all, 3);
    // Batches are of 1024 paths, and paths are added to a plan up to a batch's end: some were.
    ASSERT_TRUE(std::ranges::any_of(uninterrupted.paths, [](auto n) { return n % 1024 == 0; }));
    // Resumed time and again, with other threads, each run doing one increment only.
    int runs = 0;
    for (bool done = false; !done; ++runs) {
        set_thread_count(1 + runs % 3);
        try {
            expect_same_numbers(run(2, true), uninterrupted);
            done = true;
        } catch (const Interruption&) {
            ASSERT_LT(runs, 100);
        }
    }
    set_thread_count(0);
    EXPECT_GE(runs, 2);
    // One that starts anew does not look at what is there.
    EXPECT_THROW(run(1, false), Interruption);
    expect_same_numbers(run(0, false), uninterrupted);
}

/// In whole batches, and by the plan of an equally short pilot: as if there had been no bound.
TEST_F(Checkpointed, RunsOutOfPathsGoOnWithMore) {
    accuracy_ = 0.4;
    const BsdfTable unbounded = run(0, false);
    EXPECT_FALSE(counts_.out_of_paths);
    ASSERT_GT(std::ranges::min(unbounded.paths), 10u * 1024);
    const auto expect_bounded = [&](bool resume, uint64_t bound, uint64_t paths) {
        EXPECT_EQ(run(0, resume, empty_table(), bound).paths, std::vector<uint64_t>(2, paths));
        EXPECT_TRUE(counts_.out_of_paths);
    };
    expect_bounded(false, 3 * 1024, 3 * 1024);
    expect_bounded(true, 10 * 1024, 10 * 1024);
    expect_bounded(true, 2 * 1024, 10 * 1024);
    expect_same_numbers(run(0, true), unbounded);
    EXPECT_FALSE(counts_.out_of_paths);
}

TEST_F(Checkpointed, WhatBelongsToAnotherRunIsRefused) {
    EXPECT_THROW(run(1, false), Interruption);
    const auto refusal = [&](const BsdfTable& layout) -> std::string {
        try {
            run(1, true, layout);
        } catch (const FileError& error) {
            return error.place;
        } catch (const Interruption&) {
        }
        return "accepted";
    };
    EXPECT_EQ(refusal(empty_table()), "accepted");
    BsdfTable other = empty_table();
    other.metadata["cloth"] = "another";
    EXPECT_EQ(refusal(other), "cloth");
    other = empty_table();
    other.metadata["more"] = "said";
    EXPECT_EQ(refusal(other), "more");
    other = empty_table();
    other.incident[1].theta = 0.1;
    EXPECT_EQ(refusal(other), "incident directions");
    tracers_.pop_back();
    EXPECT_EQ(refusal(empty_table()), "sums"); // of another number of realisations
    tests::write_bytes(folder_ / "table.part", "no checkpoint");
    EXPECT_NE(refusal(empty_table()), "accepted");
}

TEST(Command, AKilledMeasurementIsResumedToTheSameBytes) {
    const tests::TemporaryFolder folder;
    // Without a wanted color, whose paths would come before the first checkpoint.
    const std::string yarn = "section = 'parallel'\nfibres = 7\nwidth_um = 60\nheight_um = 60\n"
                             "fibre = { diameter_um = 16, refractive_index = 1.5 }\n";
    const std::string cloth = tests::write_bytes(folder, "cloth.toml",
                                                 "weave = 'plain'\n[warp]\nends_per_cm = 60\n" +
                                                     yarn + "[weft]\npicks_per_cm = 60\n" + yarn)
                                  .string();
    const std::string whole = (folder / "whole.bsdf").string();
    const std::string killed = (folder / "killed.bsdf").string();
    const auto vgsp = [&](const std::string& output, unsigned killed_after) {
        return tests::run_and_kill_program({"vgsp", cloth, "--incidence", "30,20", "--side",
                                            "front", "--accuracy", "0.12", "--realisations", "2",
                                            "-o", output, "--resume"},
                                           killed_after);
    };
    const auto start = std::chrono::steady_clock::now();
    vgsp(whole, 0);
    const std::chrono::duration<double, std::micro> took = std::chrono::steady_clock::now() - start;
    int kills = 0;
    CounterRng rng(static_cast<uint64_t>(getpid()), Purpose::test, 0, 0);
    for (int i = 0; i < 3; ++i)
        kills += vgsp(killed, static_cast<unsigned>(took.count() * (0.1 + 0.4 * rng.uniform())));
    vgsp(killed, 0);
    EXPECT_EQ(tests::read_bytes(killed), tests::read_bytes(whole));
    EXPECT_FALSE(std::filesystem::exists(killed + ".part"));
    EXPECT_GT(kills, 0);
}

} // namespace
} // namespace rapport
