#include "limber/samples/motions/stances.h"

namespace limber {

FootPose planted(double side, double pitch) {
  FootPose foot{{side, kAnkleHeight, 0}, 0.12, 0, 0};
  const Vec3 toes = turnedFoot(foot, kToToes);
  foot.pitch = pitch;
  foot.ankle += toes - turnedFoot(foot, kToToes);
  foot.toes = -pitch;
  return foot;
}

FootPose lifted(double side, double height, double pitch) {
  FootPose foot = planted(side, pitch);
  foot.ankle.y() += height;
  foot.toes *= 0.4;
  return foot;
}

Stance both(const Vec3& pelvis, const FootPose& foot, const ArmPose& arm) {
  Stance stance;
  stance.pelvis = pelvis;
  stance.feet = {foot, foot};
  stance.arms = {arm, arm};
  return stance;
}

Stance leaning(Stance stance, double hips, double chest, double head) {
  stance.hips.pitch = hips;
  stance.chest.pitch = chest;
  stance.head.pitch = head;
  return stance;
}

}  // namespace limber
