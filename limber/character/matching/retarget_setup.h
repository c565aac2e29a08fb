// What every retargeting method starts from: two skeletons, which joint follows which, and how their spaces compare.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "limber/character/matching/animal_legs.h"
#include "limber/character/matching/body_frame.h"
#include "limber/character/matching/body_skin.h"
#include "limber/character/matching/neutral_pose.h"
#include "limber/character/matching/skeleton_map.h"

namespace limber {

// Frames of a whole motion, evenly spaced.
struct PoseSequence {
  std::vector<Pose> poses;
  double frameSeconds = 1.0 / 30;
};

// What a user says of a foot for a while, whatever its motion tells: whether it is planted.
struct ContactEdit {
  std::string foot;         // the source's joint (FootSpans::foot)
  double from = 0, to = 0;  // seconds of the motion
  bool planted = false;
};

enum class RootScale {
  kHipHeight,  // from the ground to the hips
  kLegLength,  // of upper and lower leg
  kNone,       // the root's displacement is not scaled
};

struct RetargetOptions {
  RootScale rootScale = RootScale::kHipHeight;
  // limb-ik: the goal of a hand. 0: where its turned bones bring it; 1: where the source's hand is, scaled as the
  // root's displacement is (Koerner's d).
  double reach = 0;
  bool contacts = true;                        // limb-ik: keep planted feet, touching hands and arms outside the body
  std::vector<ContactEdit> contactEdits = {};  // of several for one moment the last one counts
  bool smoothMotion = true;         // whole motions, with contacts: no rougher than the source (motion_smoothing.h)
  std::string solver = "two-bone";  // limb-ik: of ikMethods()
  // Height of the ground under the source, metres; none: measured from the motion where there is one, else from the
  // rest pose.
  std::optional<double> sourceGround;
  // The character's rest pose is on its ground, wherever that is, as models with a surface are. Else a person whose
  // rest pose is about the origin, as in bare skeletons, is put where the motion's ground is.
  bool characterOnGround = false;
  std::shared_ptr<const BodySkin> skin = nullptr;  // the character's: arms stay outside it (ArmClearance)
};

// What follows the source's displacement, scaled; what is attached to it goes along.
enum class RootFollows {
  kPelvis,        // of people
  kHindquarters,  // of quadrupeds that were matched by form
  kEachJoint,     // of what is matched joint by joint: all may move
};

// Whether nothing says how long a person's legs are, on one side or the other: they are one joint each, without a skin.
// Then legs are taken to be in proportion to trunks.
bool isSizedByTrunk(const Skeleton& source, const Skeleton& target, const SkeletonMap& map, const BodySkin* skin);

// Immutable once made; the skeletons must outlive it, and have no negative scales (plain_skeleton.h). `motion`, if
// given, is the input of the retarget: it gives the ground, and a rest pose for the source where its own is not
// upright.
struct RetargetSetup {
  RetargetSetup(const Skeleton& source, const Skeleton& target, SkeletonMap map, const RetargetOptions& options,
                const PoseSequence* motion = nullptr);

  // The target's pelvis position when the source's is at `pelvis`, both in their person's space.
  Vec3 positionOf(const Vec3& pelvis) const;

  const Skeleton* source;
  const Skeleton* target;
  SkeletonMap map;
  SkeletonReading sourceReading, targetReading;  // the map's, where it has them
  RetargetOptions options;
  bool person = false;  // SkeletonMap::isBiped
  // All bones are alike but for their size, and each joint of the target follows one: then every joint moves as its
  // partner does, from where it rests, and there is nothing to correct.
  bool sameBody = false;
  RootFollows rootFollows = RootFollows::kPelvis;
  Pose sourceRest;  // the rest pose, or the one that replaces it (uprightPose)
  Pose targetRest;  // the rest pose; of twins the pose in which it rests as the source does (poseAsTwin)
  NeutralPose sourceNeutral, targetNeutral;
  BodyKinematics sourceKinematics, targetKinematics;
  // Target metres for a source metre of the root's displacement. Of others than people with legs: by where these begin.
  double scale = 1;
  // The legs' fraction of the hips' height, over the source's: where ankles are high, bent legs lower the hips less.
  double legFraction = 1;
  double sourceHipHeight = 1,
         targetHipHeight = 1;                 // of no people: mean height of the joints, or size of what lies flat
  double sourceGround = 0, targetGround = 0;  // heights of the lowest foot joint of someone standing
  double sourceLowest = 0, targetLowest = 0;  // likewise, in the neutral poses
  std::vector<AnimalLeg> animalLegs;          // of no people that stand on their joints
  std::vector<Index> targetTail;              // of no people with legs: it is kept off the ground

 private:
  bool isSameBody() const;
  bool isTwin(const Twins& twins) const;
};

}  // namespace limber
