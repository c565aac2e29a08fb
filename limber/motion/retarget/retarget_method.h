// Retargeting, one interface for every method: a frame in, a frame out. One table lists the methods by name.
#pragma once

#include <memory>
#include <span>
#include <string>
#include <string_view>

#include "limber/character/matching/retarget_setup.h"

namespace limber {

// A method at work on one motion, frame after frame in order of time; never looks ahead. Not for several threads at
// once.
class FrameRetargeter {
 public:
  virtual ~FrameRetargeter() = default;
  // `source` and `target` hold the locals of all joints. `seconds` have passed since the frame before (0: the first).
  // Allocates nothing after the first frame.
  virtual void next(const Pose& source, double seconds, Pose& target) = 0;
};

struct RetargetMethod {
  std::string_view name;     // "limb-ik"
  std::string_view summary;  // one line for --help
  std::string_view paper;
  // Frame by frame. The setup must outlive what is made.
  std::unique_ptr<FrameRetargeter> (*make)(const RetargetSetup& setup);
  // What needs the whole motion: improves what the frames gave; null for methods that do not.
  void (*refine)(const RetargetSetup& setup, const PoseSequence& source, PoseSequence& target);
  bool solvesLimbs;  // then whole motions are smoothed (motion_smoothing.h)
  bool usesSolver;   // RetargetOptions::solver

  bool streams() const { return refine == nullptr; }
};

std::span<const RetargetMethod> retargetMethods();
// Throws Error kBadArgument that lists the names there are.
const RetargetMethod& findRetargetMethod(std::string_view name);
// The names of those that use a solver, "a, b".
std::string retargetMethodsWithSolver();

}  // namespace limber
