// Where hands and feet have to be: planted feet, the ground, what hands touch. Shared by the methods that solve for it.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "limber/retarget/foot_lock.h"
#include "limber/retarget/plant_detector.h"
#include "limber/retarget/root_motion.h"

namespace limber {

// Two bones and what they carry, of the target. The end hangs on the lower joint, or rides on it (RootPlacer).
struct Limb {
  Index upper = 0, lower = 0, end = 0;
  Index sourceUpper = 0, sourceEnd = 0;
  double length = 0;             // of both bones
  Vec3 goal = Vec3::Zero();      // where the end has to be, in the person's space
  bool wanted = false;           // else it may be where it is
  Quat turn = Quat::Identity();  // of the end, against its joint angles
};

struct Leg : Limb {
  std::optional<Index> toes, sourceToes;
  Vec3 kneeAhead = Vec3::UnitZ();                      // to which side the lower joint bends, in the neutral pose
  double ankleGround = 0, toesGround = 0;              // heights when standing, target
  double sourceAnkleGround = 0, sourceToesGround = 0;  // likewise, source
  FootAnchor anchor = FootAnchor::kNone;               // what holds the foot in this frame
  bool flat = false;                                   // heel and toes stand both
  double ankleFloor = 0, toesFloor = 0;                // below which neither goes in this frame
  double planted = 0;                                  // 0 to 1, comes and goes smoothly
};

// Goals frame after frame, without looking ahead. Nothing jumps when contacts come and go.
class LimbGoals {
 public:
  // Both must outlive this.
  LimbGoals(const RetargetSetup& setup, const RootPlacer& root);

  // False where nothing needs correcting: nobody with legs, or both neutral poses are one.
  bool active() const { return active_; }

  // Feet that are planted in the source stay where they came down, by their toes while the heel is up; none goes below
  // the ground. From the globals of both, the target's by joint angles alone.
  void setFeet(const BodyFrame& source, const BodyFrame& target, double seconds);
  // Whether the source jumped to the last frame: what was before it does not count.
  bool atCut() const { return cut_; }
  // How the pelvis turns (RootPlacer::turnPelvis), so that planted legs stand more as their joint angles have them: by
  // much where hips are wide for the legs, which its turns in the source would sweep further than they reach.
  Quat pelvisTurn(const BodyFrame& target) const;
  // How far the pelvis goes up, metres: so that planted legs keep the bend that their joint angles give them, on
  // average, and down as far as the longest way asks.
  double pelvisShift(const BodyFrame& target) const;
  // The most that it may go up with every leg at its goal no longer than its bones, metres.
  double mostPelvisShift(const BodyFrame& target) const;
  // Hands that are close to the other hand, the head, the trunk, a thigh or the other forearm in the source are as
  // close in the result, scaled. `reach` as in RetargetOptions.
  void setHands(const BodyFrame& source, const BodyFrame& target, double seconds);

  // Brings a goal that stretches an arm more than it is the nearer the closer it gets to what the arm can reach: the
  // elbow else snaps. setHands() does so.
  void softenReach(Limb& arm, const BodyFrame& target) const;

  // Toes of a planted foot lie on the ground while the heel goes up, though recordings have them straight: else their
  // tips would go below it. For a target that is posed but for that; soles that look up, as of someone who kneels,
  // stay as they are.
  void levelToes(const Leg& leg, BodyFrame& frame, Pose& target) const;

  std::vector<Leg>& legs() { return legs_; }
  std::vector<Limb>& arms() { return arms_; }

 private:
  // A bone that hands can touch, with distances, in hip heights, at which a touch counts wholly and not at all.
  struct Surface {
    std::array<Index, 2> source, target;
    double touching, apart;
  };
  struct Feeler {
    PlantDetector ankle, toes;
    FootLock lock;
    double plantedSpeed = 0;
  };

  bool isSame() const;
  void addPersonsLegs(const RootPlacer& root);
  void addArms(const RootPlacer& root);
  void addAnimalsLegs(const RootPlacer& root);
  void addLeg(Leg leg);
  void addSurface(const std::string& from, const std::string& to, double touching, double apart,
                  std::vector<Surface>& surfaces) const;
  void feel(const Leg& leg, Feeler& feeler, const BodyFrame& source, double seconds, FootLock::Frame& frame) const;
  // True at a cut.
  bool forgetAcrossCuts(const BodyFrame& source, double seconds);
  double loweredBy(double sourceGround, const Vec3& sourcePlace) const;
  Vec3 touchOf(const Limb& arm, const std::vector<Surface>& surfaces, const BodyFrame& source,
               const BodyFrame& target) const;
  double within(double change) const;
  double bendKeepingShift(const BodyFrame& target) const;
  double closeness(double distance, double touching, double apart) const;

  const RetargetSetup& setup_;
  std::vector<Leg> legs_;
  std::vector<Feeler> feelers_;  // of the legs
  std::vector<Limb> arms_;
  std::vector<std::vector<Surface>> surfaces_;  // for each arm
  struct Follow {
    Vec3 value = Vec3::Zero(), speed = Vec3::Zero();
  };
  std::array<Follow, 2> follows_;               // the touches of each arm as they come and go
  std::array<std::vector<Vec3>, 2> landmarks_;  // of the frame before, and room for this one's
  std::size_t frames_ = 0;
  bool cut_ = false;
  bool active_ = true;
};

}  // namespace limber
