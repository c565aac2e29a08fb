// Arms that would go into the body stay outside it.
#pragma once

#include <array>
#include <vector>

#include "limber/motion/limbs/body/skin_tube.h"
#include "limber/motion/limbs/limb_reach.h"

namespace limber {

// By the character's own skin (RetargetOptions::skin): where its elbows, forearms and hands are deeper in trunk, head
// or legs than at rest, the arm swings out about the shoulder, then the forearm about the elbow, by the least that
// takes them out. The displacement out is discontinuous where a body has edges: the caller smooths it over time, then
// swings.
class ArmClearance {
 public:
  enum class Bone { kUpper, kForearm };

  // No arms without a skin, of others than people, or where a body gets its own motion (RetargetSetup::sameBody). Both
  // must outlive this.
  ArmClearance(const RetargetSetup& setup, const RootPositioner& root);

  std::size_t arms() const { return arms_.size(); }
  // How the lower end of the bone would have to move, metres. A few microseconds.
  Vec3 displacementOut(std::size_t arm, Bone bone, const BodyFrame& frame) const;
  // Turns the bone so. `frame` are the globals of `target`; both are brought up to date.
  void swing(std::size_t arm, Bone bone, const Vec3& displacement, BodyFrame& frame, Pose& target) const;

 private:
  // Forearm lengths from the elbow; 0 to 1.5 (a hand's middle is at 1.3); where depths are probed; set by hand.
  static constexpr std::array<double, 5> kAlong = {0, 0.45, 0.75, 1.0, 1.3};
  struct Arm {
    LimbSpec limb;
    std::array<double, kAlong.size()> thick = {};   // metres that have to stay outside
    std::array<double, kAlong.size()> atRest = {};  // metres below the surface
  };

  SkinTube::Depth depthAt(const Vec3& point, const BodyFrame& frame) const;
  // The displacement that takes the arm there out again; zero where it is out.
  Vec3 displacementOutAt(const Arm& arm, std::size_t probe, const BodyFrame& frame) const;
  static Vec3 positionOf(const LimbSpec& limb, double along, const BodyFrame& frame);

  const RetargetSetup& setup_;
  LimbReach reach_;
  std::vector<SkinTube> body_;
  std::vector<Arm> arms_;
};

}  // namespace limber
