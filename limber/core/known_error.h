// Errors that people meet in ordinary work, by kind, so that a program can tell them in another language.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "limber/core/error.h"

namespace limber {

enum class ErrorKind {
  kNothingToUndo,
  kNothingToRedo,
  kJointDragged,
  kNoModel,
  kNoClip,
  kNameMissing,
  kNameTaken,         // name
  kOnlyRoot,          // joint
  kJointBelowItself,  // joint, parent
  kLastMember,
  kHoldsItself,  // name
  kModelNotMirrored,
  kNothingMirrored,
  kJointLocked,    // joint
  kPinOutside,     // joint
  kHandleCount,    // count, most
  kTooManyJoints,  // count, most
  kKeyBeforeClip,  // seconds
  kNoMotion,       // name
  kMotionTooLong,  // name
  kUnlikeBodies,   // source, target: how many joints
  kNothingMatched,
  kMatchWithoutJoint,  // part
  kMatchedTwice,       // part
  kJointMatchedTwice,  // part, joint
  kTooFewMatched,      //
  kUnlikePose,         // name
  kUnfitPose,          // name
  kNoPoseFile,
  kNoLimitsFile,
  kLimitsOfOther,  // joint
  kEmptyFile,
  kCutFile,
  kNoGlb,
  kUnknownFormat,
  kNoSurface,
  kOutOfMemory,
  kNoBvhName,   // joint
  kNoRig,       // to transfer
  kNoLimbs,     // that can be told
  kUnlikeRigs,  // source, target: how many joints
  kNoAnimation,
};

// Stable and short: "nothing-to-undo".
std::string_view errorKindName(ErrorKind kind);

// What the sentence names, by what it is: {"joint", "hips"}.
struct ErrorValue {
  std::string name;
  std::string value;
};

class KnownError : public Error {
 public:
  KnownError(ErrorKind kind, const Error& error, std::vector<ErrorValue> values = {});

  ErrorKind kind() const { return kind_; }
  const std::vector<ErrorValue>& values() const { return values_; }

 private:
  ErrorKind kind_;
  std::vector<ErrorValue> values_;
};

// Throws error.within(outer), of the kind that it has.
[[noreturn]] void throwWithin(const Error& error, std::string_view outer);

}  // namespace limber
