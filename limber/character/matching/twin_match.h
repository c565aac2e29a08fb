// Skeletons that are one and the same, whatever their joints are called and however they are numbered, turned or
// scaled.
#pragma once

#include <optional>
#include <vector>

#include "limber/skeleton/pose.h"

namespace limber {

// Which joint of the source each joint of the target is, and how to get from one space to the other.
struct Twins {
  std::vector<Index> sourceOf;  // #J of the target
  Quat turn;                    // from the source's space to the target's
  double scale = 1;             // target metres for a source metre
};

// Where both trees are the same and bones are equally long but for one scale (within 2 %), joints may be turned: of all
// mappings of one tree to the other the one that brings joints nearest, then the one with most names, or declared
// bones, in common. Nothing otherwise. Cost: joints times the 28 rotations that are tried.
std::optional<Twins> matchTwins(const Skeleton& source, const Skeleton& target);

// With every joint where its parent carries it at rest: what moves by itself, such as a foot on a root of its own, says
// nothing about how bones are turned.
Pose turnedAlone(const Skeleton& skeleton, Pose pose);

// The target's pose in which each bone is parallel to the source's in its pose (turnedAlone). A limb that is turned as
// a whole is turned back exactly; of a single bone that points elsewhere the twist about it is not known, and stays.
Pose poseAsTwin(const Skeleton& source, const Pose& sourcePose, const Skeleton& target, const Twins& twins);

}  // namespace limber
