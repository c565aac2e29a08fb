#include "limber/adapters/job_limits.h"

#include <fmt/format.h>

#include "limber/document/gltf/json_keys.h"

namespace limber {

void readJobLimits(const JsonView& object, JobLimits& limits) {
  constexpr double kMaxSeconds = 1000000;
  constexpr std::size_t kMaxMegabytes = std::size_t{1} << 24;
  if (!object.exists()) return;
  allowKeys(object, {"seconds", "memory_mb"});
  limits.seconds = object.number("seconds", limits.seconds);
  if (!(limits.seconds > 0 && limits.seconds <= kMaxSeconds)) {
    object.member("seconds").fail(fmt::format("is not above 0 and at most {}", kMaxSeconds));
  }
  if (const auto megabytes = object.count("memory_mb")) {
    if (*megabytes < 1 || *megabytes > kMaxMegabytes) {
      object.member("memory_mb").fail(fmt::format("is not from 1 to {}", kMaxMegabytes));
    }
    limits.memory = *megabytes << 20;
  }
}

}  // namespace limber
