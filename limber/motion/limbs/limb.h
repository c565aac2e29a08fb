// Arms and legs of the target as methods that solve for hands and feet see them.
#pragma once

#include <optional>
#include <span>

#include "limber/motion/limbs/body/root_motion.h"
#include "limber/motion/limbs/contacts/foot_lock.h"

namespace limber {

// Two bones and what they carry. The end hangs on the lower joint, or rides on it (RootPositioner).
struct Limb {
  Index upper = 0, lower = 0, end = 0;
  Index sourceUpper = 0, sourceEnd = 0;
  double length = 0;                // of both bones
  double folded = 0;                // how near to each other they bring the ends, at kMostBend
  std::optional<Index> hock;        // another joint that bends it (AnimalLeg)
  Vec3 goal = Vec3::Zero();         // where the end has to be, in the person's space
  bool footDriven = false;          // a foot that goes as the source's, and the leg after it
  std::optional<Index> sourceBody;  // footDriven: what the leg and another hang on
  bool ownBend = false;             // bends to its own side, wherever the joint angles bend it
  bool wanted = false;              // else it may be where it is
  Quat turn = Quat::Identity();     // of the end, against its joint angles
};

struct Leg : Limb {
  bool fore = false;  // a quadruped's, at the shoulders (TrunkTilt)
  std::optional<Index> toes, sourceToes;
  std::optional<Index> tip;                            // toes that the target alone has
  Vec3 kneeAhead = Vec3::UnitZ();                      // to which side the lower joint bends, in the neutral pose
  double ankleGround = 0, toesGround = 0;              // heights when standing, target; of the tip, too
  double sourceAnkleGround = 0, sourceToesGround = 0;  // likewise, source
  double footPitch = 1;                                // fraction of the source's (limitFootPitch)
  FootContact contact;                                 // of the source's foot in this frame
  double ankleFloor = 0, toesFloor = 0;                // below which neither goes in this frame
  double changed = 0;                                  // 0 to 1, smoothly, how much its goal is one (Pelvis::changeOf)
  Vec3 position = Vec3::Zero();                        // of the end, by the joint angles, or foot-driven
  double bentReach = 0;                                // footDriven: from hip to end if bent as the source's (LegBend)
  // footDriven: of the source's foot above where it rests, hip heights; more of people who lie down.
  double lift = 0;
  double upright = 1;  // footDriven: of the source's body, 0 where it lies on its side
};

// Limb lengths; 0.99 to 0.9995; to which a limb stretches: fully stretched knees and elbows pop; by jerk on the shared
// people (0.9995 before).
inline constexpr double kMaxStretch = 0.998;

// Leg::lift, hip heights; 0.3 to 1; from which on a foot-driven leg may leave its goal for the source's bend alone: the
// body no longer follows it; set by hand with farm animals' clips on each other.
inline constexpr double kLifted = 0.6;

bool anyFootDriven(std::span<const Leg> legs);

// None where its joints do not hang on each other, or a bone has no length.
std::optional<Limb> makeLimb(const RetargetSetup& setup, const RootPositioner& root, const LegJoints& source,
                             const LegJoints& target);
// Of a person's matched leg or arm, from hip to foot or shoulder to hand; none as well where one of them is not
// matched.
std::optional<Limb> findLimb(const RetargetSetup& setup, const RootPositioner& root, PartKind kind, Side side);

}  // namespace limber
