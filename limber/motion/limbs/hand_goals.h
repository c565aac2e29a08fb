// Where hands have to be: what they touch. Shared by the methods that solve for it.
#pragma once

#include <array>
#include <vector>

#include "limber/motion/limbs/limb.h"
#include "limber/motion/limbs/spring.h"

namespace limber {

// From what a hand touches: where a touch counts wholly, and where no more.
struct TouchDistances {
  double touching, apart;
};

// 1/seconds; 4 to 15; by which displacements of arms come and go frame by frame (touches, and arms that swing out of
// the body); by the judge on half of the shared motions (20, 15 and 10 before).
inline constexpr double kArmRate = 8;

// Goals frame after frame, without looking ahead. Nothing jumps when touches come and go.
class HandGoals {
 public:
  // None for others than people. Both must outlive this.
  HandGoals(const RetargetSetup& setup, const RootPositioner& root);

  // Hands that are close to the other hand, the head, the trunk, a thigh or the other forearm in the source are as
  // close in the result for how thick that is there, as far as that takes them half an arm's length from their joint
  // angles at most.
  // `reach` as in RetargetOptions. From the globals of both.
  void set(const BodyFrame& source, const BodyFrame& target, double seconds);
  // Forgets what was touched: the motion jumped.
  void reset() { follows_.fill({}); }

  // Brings a goal that stretches or folds an arm more than it is the nearer the closer it gets to what the arm can
  // reach: the elbow else snaps. set() does so.
  void softenReach(Arm& arm, const BodyFrame& target) const;

  std::vector<Arm>& arms() { return arms_; }

 private:
  // Metres of the source and of the target by which what is touched is as thick: where motions come without a skin, the
  // skeletons alone tell.
  struct Gauge {
    double source = 1, target = 1;
  };
  // A bone that hands can touch.
  struct Surface {
    std::array<Index, 2> source, target;
    Gauge gauge;
    TouchDistances distances;  // from the bone, of the gauge
  };

  // The distance of two parts at rest; hip heights where one of them is missing or both are at one position.
  Gauge gaugeOf(const BodyPart& from, const BodyPart& to) const;
  // None where a body lacks one of the parts.
  void addSurface(const BodyPart& from, const BodyPart& to, const Gauge& gauge, const TouchDistances& distances,
                  std::vector<Surface>& surfaces) const;
  Vec3 touchOf(const Arm& arm, const std::vector<Surface>& surfaces, const BodyFrame& source,
               const BodyFrame& target) const;

  const RetargetSetup& setup_;
  std::vector<Arm> arms_;
  std::vector<std::vector<Surface>> surfaces_;  // for each arm
  std::array<Sprung, 2> follows_;               // the touches of each arm as they come and go
  Gauge hands_;                                 // of hands that touch each other
};

}  // namespace limber
