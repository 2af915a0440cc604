#include "renderer/core/parallel.h"

#include <algorithm>
#include <atomic>
#include <exception>
#include <mutex>
#include <thread>
#include <vector>
#if defined(__SSE2__)
#include <pmmintrin.h>
#include <xmmintrin.h>
#endif

namespace rapport {
namespace {

std::atomic<int> wanted_threads = 0;

/// For the time of a loop; the caller's own thread goes back to what it had.
class FlushedDenormals {
#if defined(__SSE2__)
  public:
    FlushedDenormals() : before_(_mm_getcsr()) {
        _MM_SET_FLUSH_ZERO_MODE(_MM_FLUSH_ZERO_ON);
        _MM_SET_DENORMALS_ZERO_MODE(_MM_DENORMALS_ZERO_ON);
    }
    ~FlushedDenormals() { _mm_setcsr(before_); }
    FlushedDenormals(const FlushedDenormals&) = delete;

  private:
    unsigned before_;
#endif
};

} // namespace

void set_thread_count(int threads) { wanted_threads = std::max(threads, 0); }

int thread_count() {
    const int wanted = wanted_threads;
    return wanted > 0 ? wanted : std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
}

// Plain threads, not TBB's: bodies are long, so starting threads costs nothing, and a race between
// bodies stays visible to ThreadSanitizer, which has to look away from TBB's own code.
void parallel_for(size_t count, const std::function<void(size_t)>& body) {
    std::atomic<size_t> next = 0;
    std::mutex mutex;
    std::exception_ptr thrown;
    const auto work = [&] {
        [[maybe_unused]] const FlushedDenormals flushed;
        for (size_t i; (i = next++) < count;)
            try {
                body(i);
            } catch (...) {
                next = count;
                const std::scoped_lock lock(mutex);
                if (!thrown)
                    thrown = std::current_exception();
            }
    };
    {
        std::vector<std::jthread> helpers;
        const size_t threads = std::min(static_cast<size_t>(thread_count()), count);
        for (size_t t = 1; t < threads; ++t)
            helpers.emplace_back(work);
        work();
    }
    if (thrown)
        std::rethrow_exception(thrown);
}

} // namespace rapport
