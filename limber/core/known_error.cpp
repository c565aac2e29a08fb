#include "limber/core/known_error.h"

#include <utility>

namespace limber {

std::string_view errorKindName(ErrorKind kind) {
  switch (kind) {
    case ErrorKind::kNothingToUndo:
      return "nothing-to-undo";
    case ErrorKind::kNothingToRedo:
      return "nothing-to-redo";
    case ErrorKind::kJointDragged:
      return "joint-dragged";
    case ErrorKind::kNoModel:
      return "no-model";
    case ErrorKind::kNoClip:
      return "no-clip";
    case ErrorKind::kNameMissing:
      return "name-missing";
    case ErrorKind::kNameTaken:
      return "name-taken";
    case ErrorKind::kOnlyRoot:
      return "only-root";
    case ErrorKind::kJointBelowItself:
      return "joint-below-itself";
    case ErrorKind::kLastMember:
      return "last-member";
    case ErrorKind::kHoldsItself:
      return "holds-itself";
    case ErrorKind::kModelNotMirrored:
      return "model-not-mirrored";
    case ErrorKind::kNothingMirrored:
      return "nothing-mirrored";
    case ErrorKind::kJointLocked:
      return "joint-locked";
    case ErrorKind::kPinOutside:
      return "pin-outside";
    case ErrorKind::kHandleCount:
      return "handle-count";
    case ErrorKind::kTooManyJoints:
      return "too-many-joints";
    case ErrorKind::kKeyBeforeClip:
      return "key-before-clip";
    case ErrorKind::kNoMotion:
      return "no-motion";
    case ErrorKind::kMotionTooLong:
      return "motion-too-long";
    case ErrorKind::kUnlikeBodies:
      return "unlike-bodies";
    case ErrorKind::kNothingMatched:
      return "nothing-matched";
    case ErrorKind::kMatchWithoutJoint:
      return "match-without-joint";
    case ErrorKind::kMatchedTwice:
      return "matched-twice";
    case ErrorKind::kJointMatchedTwice:
      return "joint-matched-twice";
    case ErrorKind::kTooFewMatched:
      return "too-few-matched";
    case ErrorKind::kUnlikePose:
      return "unlike-pose";
    case ErrorKind::kUnfitPose:
      return "unfit-pose";
    case ErrorKind::kNoPoseFile:
      return "no-pose-file";
    case ErrorKind::kNoLimitsFile:
      return "no-limits-file";
    case ErrorKind::kLimitsOfOther:
      return "limits-of-other";
    case ErrorKind::kEmptyFile:
      return "empty-file";
    case ErrorKind::kCutFile:
      return "cut-file";
    case ErrorKind::kNoGlb:
      return "no-glb";
    case ErrorKind::kUnknownFormat:
      return "unknown-format";
    case ErrorKind::kNoSurface:
      return "no-surface";
    case ErrorKind::kOutOfMemory:
      return "out-of-memory";
    case ErrorKind::kNoBvhName:
      return "no-bvh-name";
    case ErrorKind::kNoRig:
      return "no-rig";
    case ErrorKind::kNoLimbs:
      return "no-limbs";
    case ErrorKind::kUnlikeRigs:
      return "unlike-rigs";
    case ErrorKind::kNoAnimation:
      return "no-animation";
  }
  return "unknown";
}

KnownError::KnownError(ErrorKind kind, const Error& error, std::vector<ErrorValue> values)
    : Error(error), kind_(kind), values_(std::move(values)) {}

void throwWithin(const Error& error, std::string_view outer) {
  if (const auto* known = dynamic_cast<const KnownError*>(&error)) {
    throw KnownError(known->kind(), error.within(outer), known->values());
  }
  throw error.within(outer);
}

}  // namespace limber
