#include "limber/jobs/job.h"

#include <array>
#include <cstring>

#include <fmt/format.h>

#include "limber/core/text/names.h"

namespace limber {

namespace {

struct NamedOutcome {
  std::string_view name;
  JobOutcome outcome;
};

constexpr std::array<NamedOutcome, 6> kOutcomes = {{{"done", JobOutcome::kDone},
                                                    {"failed", JobOutcome::kFailed},
                                                    {"crashed", JobOutcome::kCrashed},
                                                    {"timed-out", JobOutcome::kTimedOut},
                                                    {"out-of-memory", JobOutcome::kOutOfMemory},
                                                    {"not-started", JobOutcome::kNotStarted}}};

}  // namespace

std::string_view jobOutcomeName(JobOutcome outcome) {
  return kOutcomes[static_cast<std::size_t>(outcome)].name;
}

JobOutcome findJobOutcome(std::string_view name) {
  return findByName(kOutcomes, "outcome of a job", name).outcome;
}

std::string jobOutcomeText(const Job& job, const JobResult& result) {
  constexpr double kMegabyte = 1 << 20;
  switch (result.outcome) {
    case JobOutcome::kDone:
      return {};
    case JobOutcome::kFailed:
      return fmt::format("exit code {}", result.code);
    case JobOutcome::kCrashed:
      return fmt::format("signal {}", result.code);
    case JobOutcome::kTimedOut:
      return fmt::format("more than {:g} s", job.limits.seconds);
    case JobOutcome::kOutOfMemory:
      return fmt::format("more than {:.0f} MB of memory", static_cast<double>(job.limits.memory) / kMegabyte);
    case JobOutcome::kNotStarted:
      return fmt::format("cannot be run: {}", std::strerror(result.code));
  }
  return {};
}

}  // namespace limber
