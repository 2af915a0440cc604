#include "vgsp/micro_element.h"

#include "renderer/core/error.h"
#include "tests/support/large_draft.h"
#include "tests/support/long_run.h"
#include "tests/support/peak_memory.h"

#include <gtest/gtest.h>

// Drafts of hundreds of ends and picks: within the memory that is promised, or refused with what
// they would take.

namespace rapport {
namespace {

constexpr double kMostMemory = 4e9;

TEST(LargeDraft, IsMeasuredWithinTheMemoryPromised) {
    const int size = tests::long_run() ? 600 : 150;
    const Cloth cloth = tests::monofilament_cloth(size);
    const double before = tests::peak_memory();
    const MicroElement element = build_micro_element(cloth);
    EXPECT_EQ(element.fibres.chains.size(), 2u * size);
    const double promised = tests::promised_memory(element);
    EXPECT_LT(promised, kMostMemory);

    const kernel::FibreTracer tracer(element.fibres);
    const BsdfTable table =
        tests::measured(tracer, tests::clear_fibres(), {{Side::front, 0.5, 0.3}}, 5000);
    EXPECT_NEAR(table.reflectance(0)[0] + table.transmittance(0)[0] + table.unscattered[0] +
                    table.capped[0],
                1, 1e-5);
    if (before > 0) {
        const double taken = tests::peak_memory() - before;
        EXPECT_LT(taken, 1.1 * promised + 2e7);
        EXPECT_GT(taken, 0.5 * promised); // the promise is no mere bound
        std::printf("%d × %d: %zu cylinders, %.0f MB, %.0f B each (promised %.0f MB)\n", size, size,
                    element.segments, taken * 1e-6, taken / element.segments, promised * 1e-6);
    }
}

TEST(LargeDraft, IsRefusedWithWhatItWouldTake) {
    Cloth cloth = tests::monofilament_cloth(600);
    for (YarnSpec* yarn : {&cloth.warp, &cloth.weft}) {
        yarn->fibres = 37;
        yarn->width_um = yarn->height_um = 120;
        yarn->fibre.diameter_um = 12;
        yarn->irregularity = {.migration_um = 2, .deviation_degrees = 2};
    }
    try {
        build_micro_element(cloth);
        ADD_FAILURE() << "accepted";
    } catch (const FileError& error) {
        const std::string message = error.what();
        EXPECT_NE(message.find("at most 4 GB"), std::string::npos) << message;
        EXPECT_NE(message.find("600 ends × 600 picks of at least "), std::string::npos) << message;
        const size_t number = message.find("cylinders, ");
        ASSERT_NE(number, std::string::npos) << message;
        EXPECT_GT(std::stod(message.substr(number + 11)), 4) << message;
    }
}

} // namespace
} // namespace rapport
