#include "limber/character/anatomy/skeleton_size.h"

#include <algorithm>
#include <limits>

#include <fmt/format.h>

#include "limber/skeleton/clip/clip_player.h"

namespace limber {

namespace {

// Metres. The shortest and the tallest adults on record measured 0.55 and 2.72 m; small dogs are 0.3 m long, elephants
// 7.5 m. A person in another unit is far outside: 0.017 m and 170 m by centimetres, 0.043 m and 67 m by inches.
constexpr double kSmallestBody = 0.3, kLargestBody = 10;

// Is the joint of the body itself?
bool isOfBody(const Anatomy& anatomy, Index joint) {
  if (!anatomy.partOf[joint]) return false;
  const PartKind kind = anatomy.parts[*anatomy.partOf[joint]].kind;
  return kind != PartKind::kProp && kind != PartKind::kAttachment && kind != PartKind::kHair &&
         kind != PartKind::kOther;
}

// Insects and birds come smaller, fishes and snakes in any size.
bool isPersonOrQuadruped(const Anatomy& anatomy) {
  const Index legs = anatomy.pairsOf(PartKind::kLeg);
  return (legs == 1 || legs == 2) && anatomy.pairsOf(PartKind::kWing) == 0 && anatomy.certainBody();
}

}  // namespace

SkeletonSize skeletonSize(const Skeleton& skeleton, const Pose& pose, const Anatomy& anatomy) {
  const std::vector<Vec3> positions = posePositions(skeleton, pose);
  const auto countsBody = [&](Index joint) { return isOfBody(anatomy, joint); };
  bool hasBody = false;
  for (Index j = 0; j < skeleton.jointCount(); ++j) hasBody = hasBody || countsBody(j);
  Box box;
  double lowest = std::numeric_limits<double>::infinity(), highest = -lowest;
  for (Index j = 0; j < skeleton.jointCount(); ++j) {
    if (hasBody && !countsBody(j)) continue;
    box.add(positions[j]);
    const double height = anatomy.axes.up.dot(positions[j]);
    lowest = std::min(lowest, height);
    highest = std::max(highest, height);
  }
  SkeletonSize size;
  if (box.empty()) return size;
  size.height = highest - lowest;
  size.longestSide = box.longestSide();
  const Part* trunk = anatomy.find(PartKind::kTrunk);
  if (trunk && !trunk->joints.empty()) size.hips = anatomy.axes.up.dot(positions[trunk->joints.front()]) - lowest;
  return size;
}

void warnUnlikelySize(const SkeletonReading& reading, std::span<const Clip> clips, Warnings& warnings) {
  const Skeleton& skeleton = reading.skeleton();
  if (skeleton.joints.empty()) return;
  const Anatomy& anatomy = reading.anatomy();
  if (!isPersonOrQuadruped(anatomy)) return;
  // A rest pose with all joints in one point is met in motion files, whose frames then have the lengths.
  Pose pose = restPose(skeleton);
  const double atRest = skeletonSize(skeleton, pose, anatomy).longestSide;
  double least = atRest, greatest = atRest;
  const auto moved = std::find_if(clips.begin(), clips.end(), [](const Clip& clip) {
    return !clip.translations.empty() || !clip.rotations.empty() || !clip.scales.empty();
  });
  if (moved != clips.end()) {
    sampleClip(*moved, 0, pose);
    const double atStart = skeletonSize(skeleton, pose, anatomy).longestSide;
    least = std::min(least, atStart);
    greatest = std::max(greatest, atStart);
  }
  if (greatest >= kSmallestBody && least <= kLargestBody) return;
  warnings.add("unlikely-size",
               fmt::format("the body measures {:.3g} m, as hardly any person or quadruped does: is its unit of length "
                           "another?",
                           greatest < kSmallestBody ? greatest : least));
}

}  // namespace limber
