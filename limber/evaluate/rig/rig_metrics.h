// How near a skeleton comes to the one that an artist made for the same model.
#pragma once

#include <string>
#include <vector>

#include "limber/evaluate/skin/skinned_model.h"

namespace limber {

// Distances in percent of the longest side of the truth's bounding box (RigNet: Xu et al. 2020): mean nearest distances
// in both directions, averaged. Bones run from joints to their children; 100 points of each count, whatever its length.
// Joints at one position count once, and feet that inverse kinematics drives are attached to their legs (figureOf).
// jointToJoint, jointToBone, boneToBone   CD-J2J, CD-J2B, CD-B2B
// precision, recall, iou                  of joints, paired one to one within 5 % so that the sum of distances is the
// least;
//                                         iou = pairs / (joints of both - pairs)
struct RigDistances {
  Index joints = 0, truthJoints = 0;
  double jointToJoint = 0, jointToBone = 0, boneToBone = 0;
  double precision = 0, recall = 0, iou = 0;
};

// The distance of two joints that play the same bone of a person. Where the truth has no upper chest, its chest is
// compared with that of the predicted rig's chest and upper chest that is nearer.
struct NamedJointError {
  std::string bone;    // VRM 1.0
  double percent = 0;  // of the truth's height, the extent of its box along the direction from feet to head
};

struct RigComparison {
  RigDistances all, withoutFingers;
  std::vector<NamedJointError> named;  // hips, spine, chest, neck, head, arms and legs; empty where names tell nothing
  double namedMean = 0, namedWorst = 0;
};

// All joints of the predicted rig count; of the truth those that move vertices, play a bone of a person, or lie between
// such (countedJoints). Without fingers: of both the joints that bodyJoints leaves, so no face, ears or props either.
// Throws Error kUnsupported where one of the two has no rig.
RigComparison compareRigs(const SkinnedModel& predicted, const SkinnedModel& truth);
RigComparison compareRigs(const Character& predicted, const Character& truth);

// The fraction of the joints that lie inside the model's surface: a winding number above a half. Cost: O(#J #F).
double insideFraction(const SkinnedModel& model);

}  // namespace limber
