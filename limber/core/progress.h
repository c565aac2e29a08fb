// How long work reports how far it is, and how it is told to stop.
#pragma once

#include <atomic>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

namespace limber {

// A finished stage and how long it took (wall clock).
struct StageTime {
  std::string name;
  double seconds = 0;            // of its steps and all between them
  std::vector<StageTime> steps;  // in order
};

// Sum over the stages; their steps are part of them.
double totalSeconds(const std::vector<StageTime>& stages);

// Passed to every function that may take longer than a frame. A default-made Progress reports to nobody and is never
// cancelled, so callers that do not care write `Progress progress;`.
//
// Whoever strings work together opens stages; a method opens steps within the stage that it was called in.
//
// One thread drives it (stage, step, update); any thread may call cancel().
class Progress {
 public:
  // `stage` is "skin", or "skin: solve" within a step.
  using Listener = std::function<void(std::string_view stage, double fraction)>;

  Progress() = default;
  explicit Progress(Listener listener) : listener_(std::move(listener)) {}
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  // Opens the stage of that name and closes the one before. Throws Error kCancelled if cancel() was called.
  void stage(std::string_view name);
  // Opens a step of the open stage (of a stage without a name where none is open) and closes the step before.
  void step(std::string_view name);
  // Fraction of the open stage or step, 0 to 1. Cheap: call it every few thousand steps. Throws Error kCancelled
  // likewise.
  void update(double fraction);
  // Closes the last stage, so that stages() is complete.
  void finish();

  void cancel() noexcept { cancelled_.store(true, std::memory_order_relaxed); }
  bool cancelled() const noexcept { return cancelled_.load(std::memory_order_relaxed); }

  // The stages closed so far, in order.
  const std::vector<StageTime>& stages() const { return stages_; }

 private:
  void throwIfCancelled() const;
  void closeStep();
  void tell(double fraction) const;

  Listener listener_;
  std::atomic<bool> cancelled_{false};
  std::vector<StageTime> stages_;
  StageTime open_;
  bool isOpen_ = false, inStep_ = false;  // the step is the last of open_.steps
  double openedAt_ = 0, stepOpenedAt_ = 0;
};

// Seconds of a steady clock. Nothing else reads the time.
double secondsNow();

}  // namespace limber
