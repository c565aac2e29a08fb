// Arms and legs of the target as methods that solve for hands and feet see them: what they are, how they are in a
// frame, and what they have to reach.
#pragma once

#include <optional>
#include <vector>

#include "limber/motion/limbs/body/trunk_tilt.h"
#include "limber/motion/limbs/contacts/contact_track.h"
#include "limber/motion/limbs/leg_bend.h"

namespace limber {

// Two bones and what they carry, the same in all frames. The end is a child of the lower joint, or rides on it
// (RootPositioner).
struct LimbSpec {
  Index upper = 0, lower = 0, end = 0;
  Index sourceUpper = 0, sourceEnd = 0;
  double length = 0;              // of both bones
  double folded = 0;              // how near to each other they bring the ends, at kMaxBend
  std::optional<Index> hock;      // another joint that bends it (AnimalLeg)
  std::optional<Vec3> kneeAhead;  // to which side the lower joint bends, in the neutral pose; none: wherever it bends
  bool ownBend = false;           // bends to that side, wherever the joint angles bend it
};

// A foot whose path follows the source's, whatever the joint angles: the leg follows the foot.
struct FootDrive {
  LegBend bend;
  std::optional<Index> sourceBody;              // the joint that carries this leg and another
  bool uprightBody = false;                     // the trunk is over the hips: feet of a body that lies down are lifted
  double restHeight = 0, sourceRestHeight = 0;  // of the ankle, metres
  double slipSpeed = 0;                         // hip heights a second; at which a planted foot slips by half
};

// How the body follows a leg.
struct BodySupport {
  Vec3 carried = Vec3::Ones();  // fractions of its hip's displacement in which the free foot takes part
  double softStretch = 0;       // hip heights; over which the body begins to sink before the leg is stretched
  double maxSink = 0;           // hip heights; by which it sinks for a leg
  bool sinksSoftly = false;     // it comes to that bound without a kink
  bool risesAtOnce = false;     // else smoothly: as one of four feet lets go, the others would have to bend at once
  double nearest = 0;           // metres; distance from hip to foot from which on the body rises; 0: it does not
  double nearLevel = 0;         // squared sine of the leg's slope below which sinking helps it less; 0: at any slope
};

// A limb that ends in a foot.
struct LegSpec : LimbSpec {
  bool fore = false;               // at the shoulders of a trunk that tilts (TrunkTilt)
  std::optional<FootDrive> drive;  // none: the foot follows the joint angles
  BodySupport support;
  bool plantigrade = false;  // rests on its whole sole, which lies flat on the ground
  std::optional<Index> toes, sourceToes;
  std::optional<Index> tip;                            // toes that the target alone has
  double ankleGround = 0, toesGround = 0;              // heights when standing, target; of the tip, too
  double sourceAnkleGround = 0, sourceToesGround = 0;  // likewise, source
  double footPitch = 1;                                // fraction of the source's (limitFootPitch)
};

// A leg in one frame.
struct LimbState {
  FootContact contact;                   // of the source's foot
  double ankleFloor = 0, toesFloor = 0;  // below which neither goes
  double changed = 0;                    // 0 to 1, smoothly, how much its goal is one (Pelvis::changeOf)
  Vec3 position = Vec3::Zero();          // of the end, by the joint angles, or foot-driven
  // Of a foot-driven leg; of others nothing is lifted, and all is upright.
  double bentReach = 0;  // from hip to end if bent as the source's (LegBend)
  double lift = 0;       // of the source's foot above where it rests, hip heights; more of people who lie down
  double upright = 1;    // of the source's body, 0 where it lies on its side
};

// What the end of a limb has to reach in one frame.
struct LimbGoal {
  Vec3 position = Vec3::Zero();  // in the person's space
  Quat turn = Quat::Identity();  // of the end, against its joint angles
};

struct Arm {
  LimbSpec spec;
  LimbGoal goal;
};

struct Leg {
  LegSpec spec;
  LimbState state;
  LimbGoal goal;
};

// Limb lengths; 0.99 to 0.9995; to which a limb stretches: fully stretched knees and elbows pop; by jerk on the shared
// people (0.9995 before).
inline constexpr double kMaxStretch = 0.998;

// BodySupport::maxSink, and the bound of the pelvis' rise: hip heights; 0.15 to 0.5; set by hand.
inline constexpr double kMaxSink = 0.3;

// LimbState::lift, hip heights; 0.3 to 1; from which on a foot-driven leg may leave its goal for the source's bend
// alone: the body no longer follows it; set by hand with farm animals' clips on each other.
inline constexpr double kLifted = 0.6;

// None where its joints are no children of each other, or a bone has no length.
std::optional<LimbSpec> makeLimb(const RetargetSetup& setup, const RootPositioner& root, const LegJoints& source,
                                 const LegJoints& target);
// Of the first pair of legs or arms, from hip to foot or shoulder to hand; none as well where one of them is not
// matched.
std::optional<LimbSpec> findLimb(const RetargetSetup& setup, const RootPositioner& root, PartKind kind, Side side);
// The arm of an upright body: what else has arms stands on them.
std::optional<LimbSpec> findArm(const RetargetSetup& setup, const RootPositioner& root, Side side);
// All legs that both bodies have and that are solved for, those at the hips first.
std::vector<LegSpec> findLegs(const RetargetSetup& setup, const RootPositioner& root, const TrunkTilt& trunk);

}  // namespace limber
