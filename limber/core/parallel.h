// The one door to threads. Without LIMBER_THREADS (WebAssembly without shared memory) everything runs in the caller.
#pragma once

#include <cstddef>
#include <functional>

namespace limber {

// How many threads parallelFor and parallelInvoke may use from now on; 0 means as many as the machine has.
// Results never depend on it.
void setThreadCount(int count);
int threadCount();

// Calls body(begin, end) on ranges that together cover [0, count) exactly once, each at most `grain` long, in any order
// and on any thread. `body` may write only to what belongs to its range. An exception leaves after all ranges that had
// started are done; which one, if there are several, is not defined.
void parallelFor(std::size_t count, std::size_t grain, const std::function<void(std::size_t, std::size_t)>& body);

// Runs both, side by side where there are threads for it, and returns when both are done.
void parallelInvoke(const std::function<void()>& first, const std::function<void()>& second);

}  // namespace limber
