// One pose that two skeletons have in common whatever their rest poses: against it, rotations mean the same in both.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "limber/character/matching/skeleton_map.h"
#include "limber/skeleton/pose.h"

namespace limber {

enum class MapSide { kSource, kTarget };

// The joints of a part on that side, none where it is not matched.
const std::vector<Index>* jointsOfPart(const SkeletonMap& map, MapSide side, const BodyPart& part);
// The first of them.
std::optional<Index> firstOfPart(const SkeletonMap& map, MapSide side, const BodyPart& part);
// Of all parts.
std::vector<Index> matchedJoints(const SkeletonMap& map, MapSide side);

// For a person: upright, facing +Z, upper and lower arms straight out to the sides, upper and lower legs straight down.
// Trunk, neck, head, collars and feet are as in rest pose, hands and fingers follow their arms: for these the rotation
// from rest says more than the direction (a foot's joint may lie high or low above its toes). A foot that the leg's
// rotation to the neutral pose would turn by more than 25 degrees follows the leg, too. A person who stoops at rest by
// more than 25 degrees is set upright, and a head bowed by more than 45 is raised, where the limbs are human. Loose
// joints (looseJoints) are where their carriers have them. For other skeletons: the rest pose, turned to be upright
// along +Y and to face +Z as `axes` say.
//
// `resting` replaces the skeleton's rest pose, here and below; uprightPose() says why.
struct NeutralPose {
  Quat toBody;                      // from the skeleton's space to that of the person: up +Y, left +X
  std::vector<Quat> rotations;      // #J, in the person's space
  std::vector<Vec3> positions;      // #J, likewise
  std::vector<Vec3> restPositions;  // #J, in rest pose, in the person's space
};
NeutralPose neutralPose(const Skeleton& skeleton, const Pose& resting, const SkeletonMap& map, MapSide side,
                        const Axes& axes);
// The same, where the rotation to the person's space is known.
NeutralPose neutralPoseIn(const Quat& toBody, const Skeleton& skeleton, const Pose& resting, const SkeletonMap& map,
                          MapSide side);

// Does the person stand in that pose: legs and head on opposite sides of the hips? Some programs write motions whose
// rest pose has all bones along one axis; it tells nothing (hasForm, rest_form.h), but where each leg is opposite to
// the head all the same. True for skeletons without legs or head.
bool isUpright(const Skeleton& skeleton, const Pose& pose, const SkeletonMap& map, MapSide side);

// The rest pose if it is upright, else the most upright pose of the motion: legs in line with the trunk, and the trunk
// up. In a frame of a motion gravity is along -Y, and the person faces anywhere: that pose is turned as a whole to be
// upright along +Y and to face +Z, so that toBody is the identity and the motion keeps its heading, or its lying or
// crawling. The rest pose again where there is no motion.
Pose uprightPose(const Skeleton& skeleton, std::span<const Pose> motion, const SkeletonMap& map, MapSide side);

// Of people the middle between the upper legs' joints; else the hips' joint, or the first one that is matched.
Vec3 pelvisOf(const SkeletonMap& map, MapSide side, const std::vector<Vec3>& positions);

// Where the foot of the left or right leg touches the ground in front: its toes, or what hangs on it furthest to
// the front and below it where the other skeleton has no toes. `rest` are #J positions in the person's space.
std::optional<Index> toesOf(const Skeleton& skeleton, const SkeletonMap& map, MapSide side, Side leg,
                            std::span<const Vec3> rest);

// Whether the path through a part's joints to the next part's, or to its end, bends, as that of a bird's shin with its
// hock does: else they are a bone and its twist joints.
bool isBent(std::span<const Index> joints, Index end, std::span<const Vec3> positions);

// The first joints of feet and toes of people, as far as both skeletons have them.
std::vector<Index> soleJoints(const SkeletonMap& map, MapSide side);

}  // namespace limber
