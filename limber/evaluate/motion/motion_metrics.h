// How well a character moves as the source of its motion did: feet, ground, bones, smoothness.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "limber/document/asset.h"
#include "limber/evaluate/skin/self_penetration.h"
#include "limber/motion/retarget/retarget_clip.h"

namespace limber {

// Against a known answer for the same skeleton: mean of the joints' squared distances, over height squared.
struct JointError {
  double global = 0;        // of the joints' positions
  double rootRelative = 0;  // with both pelvises at one position
};

// Lengths in heights of the skeleton they are measured on: from its lowest foot joint to its head's joint, standing (of
// animals: to the highest matched joint).
// Planted is what rests in the source: a foot's or the toes' joint within 0.03 heights of where it is when
// standing and slower than 0.15 heights a second, as seen over a fifteenth of a second (recordings tremble from frame
// to frame), for a tenth of a second at least.
//
// Jerk is taken of the limbs' bones, each as the vector from its joint to the next over its length, and of the pelvis
// over the hips' height: the same angles on other proportions have the same, and long arms are not rough for being
// long.
struct MotionMetrics {
  Index frames = 0;
  Index matched = 0;         // parts of the body that were compared
  bool hasLegs = true;       // else nothing is said of limbs, feet and ground
  double boneDirection = 0;  // degrees between the directions of upper and lower limbs, mean; without legs between the
                             // turns of matched joints from rest
  double endEffector = 0;    // hands and feet seen from shoulder and hip: how far off, in limb lengths, mean
  double planted = 0;        // fraction of the source's frames in which such a joint is planted, mean over the joints
  double sliding = 0;        // of planted joints along the ground, heights a second, mean
  double sourceSliding = 0;  // the same joints in the source
  double penetration = 0;    // how deep a foot's joint goes below where it is when standing, heights, worst
  double sourcePenetration = 0;
  double jerk = 0;                      // root mean square jerk against the source's, see below (1: the same)
  double jointJerk = 0;                 // likewise, of the positions of limbs' joints, in heights
  double contactAgreement = 0;          // fraction of the source's planted frames that are planted in the result too
  double height = 1, sourceHeight = 1;  // metres

  // Not by measureMotion: with a skin, and with a known answer.
  std::optional<SelfPenetration> selfPenetration;
  std::optional<JointError> jointError;
};

// Where joints stand as a file shows them, in the person's space: a setup's skeletons have even scales (PlainSkeleton),
// the file's may differ between the axes.
struct ShownJoints {
  std::vector<Vec3> rest;                 // #J
  std::vector<std::vector<Vec3>> frames;  // of each frame, #J
};
// `original` is the file's skeleton and `frames` are its own; `toBody` as the setup's (BodyKinematics).
ShownJoints shownJoints(const Skeleton& original, const PoseSequence& frames, const Quat& toBody);

// `source` and `target` are the same moments of both; the shown ones, if given, too, and count instead. People, and
// animals by their legs (RetargetSetup::animalLegs); what has none, such as fish, by how its joints turn. Throws Error
// kBadArgument where the counts of frames differ or there are fewer than 5.
MotionMetrics measureMotion(const RetargetSetup& setup, const PoseSequence& source, const PoseSequence& target,
                            const ShownJoints* shownSource = nullptr, const ShownJoints* shownTarget = nullptr);

// `truth` and `target` are the same moments of the setup's target. Throws Error as measureMotion does.
JointError jointErrorOf(const RetargetSetup& setup, const PoseSequence& truth, const PoseSequence& target,
                        const ShownJoints* shownTruth = nullptr, const ShownJoints* shownTarget = nullptr);

Json toJson(const MotionMetrics& metrics);
std::string toText(const MotionMetrics& metrics);

}  // namespace limber
