// How the whole body moves, and what hangs loose on it: shared by the methods.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "limber/character/matching/loose_joints.h"
#include "limber/character/matching/retarget_setup.h"

namespace limber {

Vec3 middleOf(std::span<const Index> joints, const std::vector<Vec3>& positions);

// Moves a posed target to where the source's motion has it.
//
// People: the hips' translation brings the pelvis to its position; on the same body (RetargetSetup::sameBody) every
// joint is displaced from rest as its partner is, as well. Others: every matched joint is displaced from rest as its
// partner, scaled; in quadrupeds that were matched by form only the hindquarters are. Loose joints (looseJoints; of
// animals feet that ride on their shins, and where no legs are solved for what follows a joint of the source's body) are
// put where their carriers have them, except on the same body.
class RootPositioner {
 public:
  explicit RootPositioner(const RetargetSetup& setup);

  // `frame` are the globals of `target`, whose rotations are final; both are brought up to date.
  void apply(const Pose& source, const BodyFrame& sourceFrame, Pose& target, BodyFrame& frame) const;
  // Brings positions up to date with rotations that were changed, and loose joints to where their limbs end now.
  void settle(Pose& target, BodyFrame& frame) const;
  // The loose joints alone, where all else is up to date.
  void settleLoose(Pose& target, BodyFrame& frame) const;
  // Moves the pelvis by `shift`, in the person's space.
  void movePelvis(const Vec3& shift, Pose& target, BodyFrame& frame) const;

  // Turns the pelvis about the middle of the hips, in the person's space; what hangs on it keeps how it is turned. Of
  // quadrupeds that were matched by form the whole trunk turns, and legs, neck, head and tail keep their turns.
  void turnPelvis(const Quat& turn, Pose& target, BodyFrame& frame) const;
  Vec3 middleOfHips(const BodyFrame& frame) const;
  // False where no joint carries the legs: turning it does nothing.
  bool turnsPelvis() const { return pelvis_.has_value(); }

  // The joint that a loose joint rides on; the joint itself where it hangs on the body.
  Index carrierOf(Index joint) const;

 private:
  struct Loose {
    Index joint = 0, carrier = 0;
    Vec3 offset = Vec3::Zero();  // in the carrier's frame, in the person's metres
    std::optional<Quat> turn;    // likewise, of one that turns with its carrier
  };
  void findPelvis();
  void findTrunk();
  void findCarrierOfLegs();
  std::vector<Index> hindquartersOf(MapSide side) const;
  void placeHindquarters(const BodyFrame& sourceFrame, Pose& target, BodyFrame& frame) const;
  void findCarried();
  void placeEach(const Pose& source, const BodyFrame& sourceFrame, Pose& target, const BodyFrame& frame) const;
  void findLoose();
  bool isAttached(const LooseJoint& loose) const;
  void addLoose(const LooseJoint& loose);

  const RetargetSetup& setup_;
  bool movesEachJoint_;           // as its partner, scaled, not as its parent takes it along
  std::optional<Index> hips_;     // of others than people the joint that carries all legs
  std::optional<Index> pelvis_;   // the joint that carries the legs and the trunk
  std::vector<Index> hipJoints_;  // of the legs, of four those behind
  // What follows the source's displacement in a quadruped that was matched by form: the joint that carries its hind
  // legs; where that carries the forelegs too, and so lies elsewhere, the joints at which the hind legs begin.
  std::vector<Index> hindquarters_, sourceHindquarters_;
  std::vector<Index> turnsAlong_;      // joints below it that turn with it
  std::vector<Index> pelvisChildren_;  // what hangs on these and on the pelvis
  std::vector<Loose> loose_;
  std::vector<bool> carried_;  // of no people, #matches: whether nothing above it is matched, in the source either
};

}  // namespace limber
