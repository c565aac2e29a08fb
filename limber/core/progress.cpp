#include "limber/core/progress.h"

#include <chrono>
#include <utility>

#include "limber/core/error.h"

namespace limber {

double secondsNow() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

double totalSeconds(const std::vector<StageTime>& stages) {
  double sum = 0;
  for (const StageTime& stage : stages) sum += stage.seconds;
  return sum;
}

void Progress::throwIfCancelled() const {
  if (cancelled()) throw Error(ErrorCode::kCancelled, "cancelled");
}

void Progress::tell(double fraction) const {
  if (!listener_) return;
  listener_(inStep_ ? open_.name + ": " + open_.steps.back().name : open_.name, fraction);
}

void Progress::stage(std::string_view name) {
  throwIfCancelled();
  finish();
  open_ = {std::string(name), 0, {}};
  isOpen_ = true;
  openedAt_ = secondsNow();
  tell(0);
}

void Progress::step(std::string_view name) {
  if (!isOpen_) stage("");
  throwIfCancelled();
  closeStep();
  open_.steps.push_back({std::string(name), 0, {}});
  inStep_ = true;
  stepOpenedAt_ = secondsNow();
  tell(0);
}

void Progress::update(double fraction) {
  throwIfCancelled();
  tell(fraction);
}

void Progress::closeStep() {
  if (!inStep_) return;
  open_.steps.back().seconds = secondsNow() - stepOpenedAt_;
  tell(1);
  inStep_ = false;
}

void Progress::finish() {
  if (!isOpen_) return;
  closeStep();
  open_.seconds = secondsNow() - openedAt_;
  tell(1);
  stages_.push_back(std::exchange(open_, {}));
  isOpen_ = false;
}

}  // namespace limber
