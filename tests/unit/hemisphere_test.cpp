#include "renderer/preview/hemisphere.h"
#include "tests/support/synthetic_tables.h"

#include <gtest/gtest.h>

namespace rapport {
namespace {

TEST(Hemisphere, CurvesAreOfTheSideThatIsAskedFor) {
    const auto one_sided = [](const IncidentDirection& from, const glm::dvec3& to, size_t) {
        return (from.side == Side::front) == (to.z > 0) ? 0.1 : 0.02;
    };
    const TableBsdf table(tests::synthetic_table(one_sided), "one-sided");
    const glm::vec3 from(0.3f, 0, std::sqrt(0.91f));
    for (const bool along_warp : {false, true}) {
        EXPECT_NEAR(intensity_profile(table, from, false, along_warp, 21)[10], 0.1f, 0.01f);
        EXPECT_NEAR(intensity_profile(table, from, true, along_warp, 21)[10], 0.02f, 0.002f);
    }
}

} // namespace
} // namespace rapport
