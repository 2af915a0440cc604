#include "renderer/preview/rising_measurement.h"
#include "tests/support/sessions.h"

#include <atomic>

namespace rapport {
namespace {

/// The hasty first round and the next, which is measured among other fibres.
TEST(RisingMeasurement, ChartsExitsAboutTheYarnsThatASideShows) {
    Cloth cloth = read_cloth(RAPPORT_SOURCE_DIR "/scenes/cloths/quickstart.toml");
    cloth.ends_per_cm = cloth.picks_per_cm; // so that its back shows the weft
    RisingMeasurement satin(std::make_shared<const Cloth>(cloth));
    for (int round = 0; round < 2; ++round) {
        satin.advance({});
        EXPECT_EQ(satin.table().exit_axis,
                  (std::array<ConeAxis, 2>{ConeAxis::warp, ConeAxis::weft}));
    }
}

/// Whatever it is at, and as if nothing had been: nobody is let wait for the end of a stage.
TEST(RisingMeasurement, StopsAtOnceWhereverItIs) {
    const tests::SquareScene files(tests::SquareScene::Worn::measured);
    const auto cloth = std::make_shared<const Cloth>(read_cloth(files.cloth()));
    std::atomic<uint64_t> asked = 0;
    RisingMeasurement undisturbed(cloth);
    undisturbed.advance([&] {
        ++asked;
        return false;
    });
    constexpr uint64_t kColourPaths = 4096, kColours = 6, kBisections = 60;
    const BsdfTable& table = undisturbed.table();
    const uint64_t all = asked;
    EXPECT_GT(all,
              kColourPaths + kColours * kBisections + undisturbed.paths() * table.directions());

    constexpr uint64_t kStops = 20;
    for (uint64_t i = 0; i < kStops; ++i) {
        RisingMeasurement stopped(cloth);
        asked = 0;
        const uint64_t last = all * i / kStops;
        EXPECT_THROW(stopped.advance([&] { return asked++ >= last; }), Stopped);
        EXPECT_LE(asked, last + 64); // once by each thread
        EXPECT_EQ(stopped.rounds(), 0);
        if (i % 8 != 3)
            continue;
        stopped.advance({});
        EXPECT_EQ(stopped.table().intensity, table.intensity);
    }
}

} // namespace
} // namespace rapport
