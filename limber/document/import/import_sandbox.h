// Runs code that is not to be trusted with a hostile file (an importer of another project) where it can do no harm.
#pragma once

#include <cstddef>
#include <functional>

#include "limber/core/error.h"
#include "limber/core/file/file.h"

namespace limber {

struct SandboxLimits {
  std::size_t memory = std::size_t{512} << 20;  // bytes that the work may add to the process's address space
  double seconds = 10;                          // of processor time (rounded up); ten times that on the clock
};

// The bytes that `work` returns, made in a forked child process: a crash, a hang or a hunger for memory ends the child
// and becomes an Error kBadData here; an Error that `work` throws is thrown here again. The child sees this process's
// memory as it is at the call and changes nothing of it. `work` must not start or wait for threads.
//
// Where the system cannot fork, `work` runs here, unguarded. Memory is not limited under the address sanitizer.
// Cost: about a millisecond, and a copy of the result through a pipe.
Bytes runIsolated(const std::function<Bytes()>& work, const SandboxLimits& limits);

// Called by such work: it may ask for so many bytes more. Does nothing where memory is not limited.
void allowMemory(std::size_t bytes);

}  // namespace limber
