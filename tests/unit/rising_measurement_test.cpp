#include "renderer/preview/rising_measurement.h"

#include <gtest/gtest.h>

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

} // namespace
} // namespace rapport
