#include "progress_line.h"

#include <csignal>
#include <cstdio>
#include <string>
#include <utility>

#include <fmt/format.h>
#include <unistd.h>

#include "limber/core/text/printable.h"

namespace limber::cli {

namespace {

constexpr double kQuietSeconds = 1.0, kRedrawSeconds = 0.1;

std::atomic<Progress*> activeProgress{nullptr};
std::atomic<bool> signalled{false};
static_assert(std::atomic<Progress*>::is_always_lock_free);  // a signal handler may use nothing else

void onSignal(int) {
  signalled.store(true);
  if (Progress* progress = activeProgress.load()) progress->cancel();
}

// Without SA_RESTART, so that waiting for standard input ends too. The second signal ends the program outright.
void installHandlers() {
  struct sigaction action = {};
  action.sa_handler = &onSignal;
  action.sa_flags = SA_RESETHAND;
  sigaction(SIGINT, &action, nullptr);
  sigaction(SIGTERM, &action, nullptr);
}

}  // namespace

TerminalProgress::TerminalProgress(bool quiet)
    : enabled_(!quiet && isatty(STDERR_FILENO)),
      startedAt_(secondsNow()),
      progress_([this](std::string_view stage, double fraction) { draw(stage, fraction); }) {
  activeProgress.store(&progress_);
  installHandlers();
}

TerminalProgress::~TerminalProgress() {
  activeProgress.store(nullptr);
  clear();
}

void TerminalProgress::finish() {
  progress_.finish();
  clear();
}

void TerminalProgress::describe(std::string text) {
  description_ = std::move(text);
}

void TerminalProgress::draw(std::string_view stage, double fraction) {
  if (!enabled_) return;
  const double now = secondsNow();
  if (now - startedAt_ < kQuietSeconds || now - drawnAt_ < kRedrawSeconds) return;
  drawnAt_ = now;
  drawn_ = true;
  const std::string text = description_.empty() ? fmt::format("{} {:.0f} %", stage, 100 * fraction) : description_;
  fmt::print(stderr, "\r{}\x1b[K", printable(text));
  std::fflush(stderr);
}

void TerminalProgress::clear() {
  if (!drawn_) return;
  fmt::print(stderr, "\r\x1b[K");
  std::fflush(stderr);
  drawn_ = false;
}

std::string timeText(double seconds) {
  constexpr double kMinute = 60, kHour = 3600;
  if (seconds < 2 * kMinute) return fmt::format("{:.0f} s", seconds);
  if (seconds < 2 * kHour) return fmt::format("{:.0f} min", seconds / kMinute);
  return fmt::format("{:.1f} h", seconds / kHour);
}

bool interrupted() {
  return signalled.load();
}

}  // namespace limber::cli
