// Motions whose correct result is known because code made the body: the motion's own, with unambiguous changes.
#pragma once

#include <string_view>
#include <vector>

#include "limber/motion/retarget/retarget_method.h"

namespace limber {

struct KnownAnswer {
  std::string_view change;  // "own", "renamed", "reposed", "scaled", "mirrored"
  Skeleton body;            // joints in the order of the motion's skeleton
  double scale = 1;         // of its lengths, over the motion's
};

// As it is; under names that say nothing; at 0.6 of the size; with arms (or forelegs) and legs turned at rest, of
// bodies that rest with head and feet apart; its mirror image by a negative scale, of bodies whose two sides are alike
// within 1 %.
std::vector<KnownAnswer> knownAnswers(const Skeleton& motion);

// How far from the answer the method takes the worst matched joint in the worst frame, in metres over the body's height
// (standingHeight), times `scale`, each over its own ground. Throws Error as matchSkeletons does.
double errorOfAnswer(const RetargetMethod& method, const Skeleton& motion, const PoseSequence& frames,
                     const KnownAnswer& answer, const RetargetOptions& options = {});

}  // namespace limber
