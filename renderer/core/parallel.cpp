#include "renderer/core/parallel.h"

#include <memory>
#include <mutex>
#include <tbb/global_control.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>
#if defined(__SSE2__)
#include <pmmintrin.h>
#include <xmmintrin.h>
#endif

namespace rapport {
namespace {

std::mutex control_mutex;
std::unique_ptr<tbb::global_control> control;

void flush_denormals() {
#if defined(__SSE2__)
    _MM_SET_FLUSH_ZERO_MODE(_MM_FLUSH_ZERO_ON);
    _MM_SET_DENORMALS_ZERO_MODE(_MM_DENORMALS_ZERO_ON);
#endif
}

} // namespace

void set_thread_count(int threads) {
    const std::scoped_lock lock(control_mutex);
    control.reset(); // the smallest of all live limits holds, so the old one must go first
    if (threads > 0)
        control = std::make_unique<tbb::global_control>(
            tbb::global_control::max_allowed_parallelism, static_cast<size_t>(threads));
}

int thread_count() {
    return static_cast<int>(
        tbb::global_control::active_value(tbb::global_control::max_allowed_parallelism));
}

void parallel_for(size_t count, const std::function<void(size_t)>& body) {
    // An arena of the asked size: more threads than cores are honoured too.
    tbb::task_arena arena(thread_count());
    arena.execute([&] {
        tbb::parallel_for(
            size_t{0}, count,
            [&](size_t i) {
                flush_denormals();
                body(i);
            },
            tbb::simple_partitioner{});
    });
}

} // namespace rapport
