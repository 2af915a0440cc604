#include "materials/table/table_bsdf.h"
#include "tests/support/synthetic_tables.h"

#include <atomic>
#include <cstdlib>
#include <gtest/gtest.h>
#include <new>
#include <vector>

// A file of its own, for it counts what the whole program allocates.

namespace {
std::atomic<size_t> allocations{0};
} // namespace
// Out of line, or GCC sees that what came from `new` goes to `free`.
[[gnu::noinline]] void* operator new(size_t size) {
    ++allocations;
    if (void* const memory = std::malloc(size))
        return memory;
    throw std::bad_alloc();
}
[[gnu::noinline]] void operator delete(void* memory) noexcept { std::free(memory); }
[[gnu::noinline]] void operator delete(void* memory, size_t) noexcept { std::free(memory); }

namespace rapport {
namespace {

TEST(TableBsdf, LookingUpAllocatesNothing) {
    const TableBsdf bsdf(tests::synthetic_table(tests::satin_intensity, 0.04), "satin.bsdf");
    std::vector<glm::vec3> directions;
    for (const double theta : {0.0, 20.0, 57.0, 86.0, 89.9, 90.1, 120.0, 180.0})
        for (const double phi : {0.0, 77.0, 200.0})
            directions.emplace_back(spherical_direction(radians(theta), radians(phi)));
    Rgb sum(0);
    const size_t before = allocations;
    for (const glm::vec3& eye : directions)
        for (const glm::vec3& light : directions) {
            sum += bsdf.eval(eye, light) + bsdf.pdf(eye, light);
            sum += bsdf.eval_and_pdf(eye, light).intensity;
            if (const auto sample = bsdf.sample(eye, 0.3f, {0.4f, 0.6f}))
                sum += sample->weight;
            sum += bsdf.albedo(eye) + bsdf.unscattered(eye);
        }
    const size_t after = allocations;
    EXPECT_EQ(after, before);
    EXPECT_GT(sum.r, 0);
    EXPECT_GT(after, 0u); // they are counted
}

} // namespace
} // namespace rapport
