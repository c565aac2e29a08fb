#include "limber/adapters/job_limits.h"

#include <fmt/format.h>

#include "limber/document/gltf/json_keys.h"

namespace limber {

void readJobLimits(const JsonView& object, JobLimits& limits) {
  constexpr double kMostSeconds = 1000000;
  constexpr std::size_t kMostMegabytes = std::size_t{1} << 24;
  if (!object.exists()) return;
  allowKeys(object, {"seconds", "memory_mb"});
  limits.seconds = object.number("seconds", limits.seconds);
  if (!(limits.seconds > 0 && limits.seconds <= kMostSeconds)) {
    object.member("seconds").fail(fmt::format("is not above 0 and at most {}", kMostSeconds));
  }
  if (const auto megabytes = object.count("memory_mb")) {
    if (*megabytes < 1 || *megabytes > kMostMegabytes) {
      object.member("memory_mb").fail(fmt::format("is not from 1 to {}", kMostMegabytes));
    }
    limits.memory = *megabytes << 20;
  }
}

}  // namespace limber
