#include "limber/core/progress.h"

#include <chrono>

#include "limber/core/error.h"

namespace limber {

double secondsNow() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

void Progress::throwIfCancelled() const {
  if (cancelled()) throw Error(ErrorCode::kCancelled, "cancelled");
}

void Progress::stage(std::string_view name) {
  throwIfCancelled();
  finish();
  open_ = name;
  openedAt_ = secondsNow();
  if (listener_) listener_(open_, 0.0);
}

void Progress::update(double fraction) {
  throwIfCancelled();
  if (listener_) listener_(open_, fraction);
}

void Progress::finish() {
  if (open_.empty()) return;
  stages_.push_back({open_, secondsNow() - openedAt_});
  if (listener_) listener_(open_, 1.0);
  open_.clear();
}

}  // namespace limber
