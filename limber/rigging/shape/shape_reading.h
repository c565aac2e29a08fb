// What kind of body a model has, read off its shape.
#pragma once

#include <optional>
#include <vector>

#include "limber/character/anatomy/anatomy.h"
#include "limber/rigging/body/anatomical_frame.h"
#include "limber/rigging/body/body_curves.h"

namespace limber {

// By the limbs that a body rests on, and the direction of its trunk.
enum class BodyPlan {
  kUnknown,
  kUpright,   // on two legs at the lower end of the trunk: people, penguins, robots
  kTwoLegs,   // on two legs, the trunk across: dinosaurs, hens
  kFourLegs,  // on two pairs
  kManyLegs,  // on three pairs and more: insects, spiders
  kSwimming,  // on none, the trunk across and thick in the middle: fish, whales
  kCrawling,  // on none, the trunk long and thin: snakes, worms
};

// A limb of which there is one on either side; the left one.
struct PairedLimb {
  std::size_t curve = 0;             // of ShapeReading::curves
  std::size_t at = 0;                // the trunk's point where it hangs
  PartKind kind = PartKind::kOther;  // by its form
  double legLike = 0;                // 0 to 1: it goes down to the ground and is as thick as a leg
  bool isLeg = false;
};

inline constexpr double kBroadWing = 3;       // times as wide as thick: no arm
inline constexpr double kHeadFraction = 0.1;  // of the trunk from the head on: what hangs there is no arm

struct ShapeReading {
  AnatomicalFrame frame;          // with its front where the head is
  std::vector<BodyCurve> curves;  // in the frame (BodyCurve::Point); the trunk comes first, and begins at the head
  std::vector<PairedLimb> limbs;  // the foremost first
  BodyPlan plan = BodyPlan::kUnknown;
  double confidence = 0;      // that the plan is right, 0 to 1
  std::vector<double> along;  // by the trunk's point: path length from the head, 1 at the other end

  const BodyCurve& trunk() const { return curves.front(); }
  std::vector<PairedLimb> legs() const;
  // The longest pair of long, broad limbs that are no legs or ears; of four-legged animals by the front legs or behind.
  std::optional<PairedLimb> wings() const;
};

// Reads the curves of a symmetric body (bodyCurves) with the anatomy of a skeleton that is laid along them: which end
// is the head, which limbs are arms, wings or fins. The limbs that it rests on are counted.
//
// frames  possibleFrames: the up of the likeliest is kept; the front, too, where `isFrontGiven`
// None where the body is not symmetric, or has no trunk between left and right. Cost: about 30 ms.
std::optional<ShapeReading> readShape(const BodyVolume& body, const std::vector<AnatomicalFrame>& frames,
                                      bool isFrontGiven);

}  // namespace limber
