#include "limber/core/parallel.h"

#include <algorithm>

#ifdef LIMBER_THREADS
#include <memory>
#include <mutex>
#include <thread>

#include <tbb/blocked_range.h>
#include <tbb/global_control.h>
#include <tbb/parallel_for.h>
#include <tbb/parallel_invoke.h>
#endif

namespace limber {

#ifdef LIMBER_THREADS

namespace {

std::mutex limitMutex;
std::unique_ptr<tbb::global_control> limit;  // guarded by limitMutex
int limitCount = 0;                          // guarded by limitMutex; 0: no limit of ours

}  // namespace

void setThreadCount(int count) {
  const std::lock_guard lock(limitMutex);
  limit.reset();
  limitCount = std::max(count, 0);
  if (limitCount > 0) {
    limit = std::make_unique<tbb::global_control>(tbb::global_control::max_allowed_parallelism, limitCount);
  }
}

int threadCount() {
  const std::lock_guard lock(limitMutex);
  return limitCount > 0 ? limitCount : std::max(1u, std::thread::hardware_concurrency());
}

void parallelFor(std::size_t count, std::size_t grain, const std::function<void(std::size_t, std::size_t)>& body) {
  grain = std::max<std::size_t>(grain, 1);
  if (count <= grain) {
    if (count > 0) body(0, count);
    return;
  }
  tbb::parallel_for(
      tbb::blocked_range<std::size_t>(0, count, grain),
      [&](const tbb::blocked_range<std::size_t>& range) { body(range.begin(), range.end()); },
      tbb::simple_partitioner());
}

void parallelInvoke(const std::function<void()>& first, const std::function<void()>& second) {
  tbb::parallel_invoke(first, second);
}

#else

void setThreadCount(int) {}
int threadCount() {
  return 1;
}

void parallelFor(std::size_t count, std::size_t grain, const std::function<void(std::size_t, std::size_t)>& body) {
  grain = std::max<std::size_t>(grain, 1);
  for (std::size_t begin = 0; begin < count; begin += grain) body(begin, std::min(begin + grain, count));
}

void parallelInvoke(const std::function<void()>& first, const std::function<void()>& second) {
  first();
  second();
}

#endif

}  // namespace limber
