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
    for (const Side lit : {Side::front, Side::back})
        for (const Side seen : {Side::front, Side::back})
            for (const bool along_warp : {false, true}) {
                const glm::vec3 from = disc_direction({0.3f, 0}, lit);
                EXPECT_NEAR(intensity_profile(table, from, seen, along_warp, 21)[10],
                            lit == seen ? 0.1f : 0.02f, 0.01f);
            }
}

} // namespace
} // namespace rapport
