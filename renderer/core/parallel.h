#pragma once

#include <cstddef>
#include <functional>

namespace rapport {

/// How many threads parallel loops use from now on; 0 = as many as the machine has.
void set_thread_count(int threads);
int thread_count();

/// Calls `body(i)` for each i in [0, count), in any order, on any thread; an exception thrown by a
/// body stops the loop and is thrown again here. For results that do not depend on the thread
/// count, let i be a batch of fixed size that fills its own slot, and reduce the slots in order.
/// Each body runs with denormals flushed to zero, as Embree wants it.
void parallel_for(size_t count, const std::function<void(size_t)>& body);

} // namespace rapport
