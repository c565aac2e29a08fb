#include "limber/character/anatomy/skeleton_mirror.h"

#include "limber/character/anatomy/half_body.h"
#include "limber/character/anatomy/names/joint_words.h"
#include "limber/skeleton/pose.h"

namespace limber {

SkeletonMirror mirrorOf(const Skeleton& skeleton) {
  SkeletonMirror mirror;
  mirror.partner.resize(skeleton.jointCount());
  for (Index j = 0; j < mirror.partner.size(); ++j) mirror.partner[j] = j;
  if (skeleton.joints.empty()) return mirror;
  const HalfBody body =
      foldBody(JointTree(skeleton), restPositions(skeleton), partnersByName(skeleton, wordsOfJoints(skeleton)));
  mirror.normal = body.lateral;
  for (const HalfJoint& half : body.joints) {
    if (!half.partner) continue;
    mirror.partner[half.joint] = *half.partner;
    mirror.partner[*half.partner] = half.joint;
  }
  return mirror;
}

}  // namespace limber
