#include "materials/table/float4.h"

#include "renderer/core/rng.h"

#include <algorithm>
#include <gtest/gtest.h>
#include <limits>
#include <vector>

namespace rapport {
namespace {

TEST(CountUpTo, IsAsManyAsAreNotAbove) {
    CounterRng rng(3, Purpose::test, 0, 0);
    for (const size_t count : {1, 15, 16, 17, 24, 64, 65, 80, 81, 97, 500, 512, 4097}) {
        const size_t lines = Line::lines(count);
        // Of eighths, so that many are equal, as are the shares of empty bins.
        std::vector<float> ascending(count);
        for (float& number : ascending)
            number = std::floor(rng.uniform_float() * static_cast<float>(count) / 8) / 8;
        std::ranges::sort(ascending);
        std::vector<Line> list(lines);
        for (size_t i = 0; i < 16 * lines; ++i)
            list[i / 16].numbers[i % 16] =
                i < count ? ascending[i] : std::numeric_limits<float>::infinity();
        const auto expect_same = [&](float x) {
            const auto above = std::ranges::upper_bound(ascending, x);
            EXPECT_EQ(count_up_to(list.data(), lines, x), size_t(above - ascending.begin()))
                << x << " of " << count;
        };
        for (const float number : ascending) {
            expect_same(number);
            expect_same(number + 0.01f);
            expect_same(number - 0.01f);
        }
    }
}

} // namespace
} // namespace rapport
