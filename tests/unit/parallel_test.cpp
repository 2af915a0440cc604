#include "renderer/core/parallel.h"

#include "renderer/core/rng.h"

#include <atomic>
#include <cmath>
#include <gtest/gtest.h>
#include <limits>
#include <numeric>
#include <stdexcept>
#include <vector>

using namespace rapport;

namespace {

/// Sum of many random numbers of very different size, batch by batch, reduced in order.
double batched_sum() {
    std::vector<double> sums(200);
    parallel_for(sums.size(), [&](size_t batch) {
        CounterRng rng(1, Purpose::test, batch, 0);
        for (int i = 0; i < 500; ++i)
            sums[batch] += std::exp(40 * rng.uniform());
    });
    return std::accumulate(sums.begin(), sums.end(), 0.0);
}

class Parallel : public testing::Test {
  protected:
    void TearDown() override { set_thread_count(0); }
};

} // namespace

TEST_F(Parallel, ResultDoesNotDependOnTheThreads) {
    set_thread_count(1);
    const double expected = batched_sum();
    for (const int threads : {2, 3, 7}) {
        set_thread_count(threads);
        EXPECT_EQ(thread_count(), threads);
        for (int repeat = 0; repeat < 5; ++repeat)
            EXPECT_EQ(batched_sum(), expected);
    }
}

TEST_F(Parallel, EveryIndexOnce) {
    for (const size_t count : {0u, 1u, 2u, 1000u}) {
        std::vector<std::atomic<int>> calls(count);
        parallel_for(count, [&](size_t i) { ++calls[i]; });
        for (const std::atomic<int>& n : calls)
            EXPECT_EQ(n, 1);
    }
}

TEST_F(Parallel, ExceptionsComeBack) {
    for (const int threads : {1, 2, 7}) {
        set_thread_count(threads);
        std::atomic<int> calls = 0;
        const auto body = [&](size_t i) {
            ++calls;
            if (i == 10)
                throw std::runtime_error("ten");
        };
        try {
            parallel_for(1000000, body);
            ADD_FAILURE() << "no exception";
        } catch (const std::runtime_error& error) {
            EXPECT_STREQ(error.what(), "ten");
        }
        EXPECT_LT(calls, 1000000); // the loop stopped early
        EXPECT_EQ(batched_sum(), batched_sum());
    }
}

TEST_F(Parallel, LoopsCanBeNested) {
    set_thread_count(3);
    std::atomic<int> calls = 0;
    parallel_for(10, [&](size_t) { parallel_for(10, [&](size_t) { ++calls; }); });
    EXPECT_EQ(calls, 100);
}

#if defined(__SSE2__)
TEST_F(Parallel, DenormalsAreFlushed) {
    volatile float smallest = std::numeric_limits<float>::min();
    std::atomic<int> flushed = 0;
    parallel_for(100, [&](size_t) { flushed += smallest * 0.5f == 0; });
    EXPECT_EQ(flushed, 100);
}
#endif
