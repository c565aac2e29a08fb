// Where feet have to be: planted, on the ground, as the pelvis goes along. Shared by the methods that solve for it.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "limber/motion/limbs/body/body_lift.h"
#include "limber/motion/limbs/body/pelvis.h"
#include "limber/motion/limbs/body/tail_lift.h"
#include "limber/motion/limbs/contacts/contact_track.h"
#include "limber/motion/limbs/contacts/foot_lock.h"
#include "limber/motion/limbs/limb.h"

namespace limber {

// Goals frame after frame, without looking ahead. Nothing jumps when contacts come and go.
class LimbGoals {
 public:
  // Both must outlive this.
  LimbGoals(const RetargetSetup& setup, const RootPositioner& root);

  // False where nothing needs correcting: nobody with legs, or the same body (RetargetSetup::sameBody).
  bool active() const { return active_; }

  // Reads which feet are planted in the source; wide hips, long feet and such as stand flat swing less than the
  // source's (Pelvis::levelHips, limitFootPitch), and bodies that lie do so on the ground (BodyLift). Before setFeet(),
  // of the target by joint angles alone.
  void adaptPose(const BodyFrame& source, double seconds, Pose& target, BodyFrame& frame);
  // Feet that are planted in the source stay where they came down, by their toes while the heel is up; none goes below
  // the ground. From the globals of both. The goals are for legs whose hips go with
  // the pelvis (Pelvis::moveFor).
  void setFeet(const BodyFrame& source, const BodyFrame& target, double seconds);
  // The lifted foot of a foot-driven leg comes as near to its hip as the source's does for its leg's length, and
  // none stretches its leg wholly: knees else fold and snap. For hips that are where they stay.
  void bendAsSource(Leg& leg, const BodyFrame& target) const;
  // Whether the source jumped to the last frame: what was before it does not count.
  bool atCut() const { return contacts_.atCut(); }
  // Of the legs, for a ContactTrack of the whole motion.
  std::vector<WatchedFoot> watchedFeet() const;
  // Toes of a planted foot lie on the ground while the heel goes up, though recordings have them straight: else their
  // tips would go below it. So do toes that the source lacks wherever they are near the ground, and their foot tips no
  // further than lets them (keepTipUp). For a target that is posed but for that; soles that look up, as of someone who
  // kneels, stay as they are.
  void levelToes(const Leg& leg, BodyFrame& frame, Pose& target) const;

  // How the pelvis follows these goals; `target` as for setFeet(). An animal's rises and sinks smoothly: as one of four
  // feet lets go, the others would have to bend at once (feet on roots of their own let go slowly anyway).
  Pelvis::Move pelvisMove(const BodyFrame& target) const;
  const Pelvis& pelvis() const { return pelvis_; }
  // For a target that is posed but for that.
  const TailLift& tail() const { return tail_; }
  std::vector<Leg>& legs() { return legs_; }
  std::vector<LegSpec> specs() const;
  // Whether any foot follows the source's (FootDrive).
  bool feetAreDriven() const;

 private:
  // Of a leg's foot, what lasts from frame to frame.
  struct FootState {
    FootLock lock;
    double changedSpeed = 0;
    FootLock::Frame foot;              // as its joint angles have it
    SprungNumber ankleFall, toesFall;  // how fast the free foot comes down, metres a second, without trembling
    Vec3 carried = Vec3::Zero();       // by its hip
    Vec3 sourceEnd = Vec3::Zero();     // of a foot-driven leg, in the frame before
  };

  SprungNumber nextRise(const BodyFrame& target, double seconds) const;
  void readFoot(Leg& leg, FootState& state, const BodyFrame& source, const BodyFrame& target, double seconds) const;
  Quat turnOfBody(const FootDrive& drive, const BodyFrame& source) const;
  Vec3 turnedAsBody(const Vec3& displacement, const FootDrive& drive, const BodyFrame& source) const;
  Vec3 drivenPosition(const LegSpec& leg, const BodyFrame& source, const BodyFrame& target) const;
  void driveFoot(Leg& leg, FootState& state, const BodyFrame& source, const BodyFrame& target, double seconds) const;
  void carryFeet(const BodyFrame& target, double seconds);
  void setFoot(Leg& leg, const FootState& state, FootLock& lock, double seconds) const;
  void keepAboveGround(Leg& leg, const FootLock::Frame& foot, const FootState& state) const;
  double heightOverGround(const Leg& leg, const BodyFrame& target) const;
  double loweredBy(const LegSpec& leg, double sourceGround, const Vec3& sourcePosition) const;

  const RetargetSetup& setup_;
  const RootPositioner& root_;
  Pelvis pelvis_;
  BodyLift lift_;
  TailLift tail_;
  std::vector<Leg> legs_;
  ContactReader contacts_;         // of the legs
  std::vector<FootState> states_;  // likewise
  SprungNumber rise_;              // of the pelvis
  bool active_ = true;
};

}  // namespace limber
