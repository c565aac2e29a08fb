// How well a figure matches a body.
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "limber/geometry/mesh/signed_distance.h"
#include "limber/rigging/figure/figure.h"

namespace limber {

// Joints of a figure whose positions are known.
struct FigurePin {
  enum class Joint { kHead, kNeck, kHips, kRoot, kMiddle, kAnkle, kTip };
  Joint joint = Joint::kHead;
  int limb = 0;  // of the last four
  Vec3 position = Vec3::Zero();
};

// Where a figure has the joint of a pin.
Vec3 positionOf(const Figure& figure, const FigurePin& pin);

// Nobody's limbs lie below it.
struct FigureGround {
  Vec3 up = Vec3::UnitY();
  double height = 0;  // along `up`
};

// Asks of points round the bones of a figure whether the body's surface lies where theirs would: 1 where it does, 0
// where the part is hidden in more of the body (a plinth, a garment, another limb), -1 where it would stick out. All
// that follows are means of such answers over a part's surface, less what is unlikely; larger is better.
//
// Cost: about a hundred lookups of the distance for a limb.
class FigureMatch {
 public:
  // Of this body, which must outlive it. Figures are the worse the farther they are from the pins, and the deeper they
  // are in the ground.
  explicit FigureMatch(const SignedDistance& distance, std::vector<FigurePin> pins = {},
                       std::optional<FigureGround> ground = {});

  double head(const Vec3& middle, double radius) const;  // at most 1
  double neck(const Figure& figure) const;               // at most 1
  double chest(const Figure& figure) const;              // with shoulders and neck; at most 2.2
  double trunk(const Figure& figure) const;              // head, chest, pelvis, and how the trunk is bent
  double upper(const Figure& figure, int limb) const;    // of the upper bone alone; at most 1
  double lower(int limb, const Vec3& from, const Vec3& direction, double length, double stature) const;  // at most 1
  double foot(const Figure& figure, const Vec3& ankle, const Vec3& direction) const;
  double limb(const Figure& figure, int limb) const;  // both bones and its end; at most 2.6

  // What pins of a limb cost where it is; up to its elbow or knee alone, where `upToMiddle`.
  double pinCost(const Figure& figure, int limb, bool upToMiddle = false) const;

  // How far a position lies inside the trunk or head, 0 to 1.
  double insideTrunk(const Figure& figure, const Vec3& position) const;
  // How far a position lies in the ground, 0 to 1.
  double inGround(const Figure& figure, const Vec3& position) const;

 private:
  static constexpr std::size_t kRing = 8, kOval = 12, kBall = 32;  // points
  enum class Hidden { kFree, kCosts };
  // Directions from a position within a part to its surface, x, y and z apart, and the distances.
  template <std::size_t N>
  struct Spokes {
    std::array<std::array<float, N>, 3> directions;
    std::array<float, N> radii;

    void set(std::size_t i, const Vec3& unit, double radius) {
      for (int axis = 0; axis < 3; ++axis) directions[axis][i] = static_cast<float>(unit[axis]);
      radii[i] = static_cast<float>(radius);
    }
  };
  template <std::size_t N>
  std::array<float, N> answers(const Vec3& middle, const Spokes<N>& spokes, Hidden hidden) const;
  template <std::size_t N>
  double meanAnswer(const Vec3& middle, const Spokes<N>& spokes, Hidden hidden) const;
  double answer(const Vec3& middle, const Vec3& direction, double radius) const;
  using Circle = std::array<std::array<float, kRing>, 3>;  // directions, x, y and z apart
  Circle circleRound(const Vec3& axis) const;
  double ring(const Vec3& middle, const Circle& circle, double radius) const;
  double bone(const Vec3& from, const Vec3& direction, double length, const std::array<double, 2>& radii,
              const std::array<double, 2>& part, int rings) const;
  double oval(const Vec3& middle, const Mat3& axes, double halfWidth, double halfDepth) const;

  double costOf(const FigurePin& pin, const Figure& figure) const;
  double trunkPinCost(const Figure& figure) const;

  const SignedDistance& distance_;
  std::vector<FigurePin> pins_;
  std::optional<FigureGround> ground_;
  std::vector<Vec3> ball_;                        // directions, evenly
  std::array<std::array<float, kRing>, 2> ring_;  // cosines and sines
  std::vector<std::array<double, 2>> oval_;       // of a circle
};

// `count` directions, evenly over the sphere.
std::vector<Vec3> evenDirections(int count);

// How much the parts of a limb count in FigureMatch::limb.
struct LimbWeights {
  double upper, lower, end;
};
const LimbWeights& weightsOf(int limb);

// The cost of a head that is bent against the chest.
double nodCost(const Figure& figure);

// The cost of an unlikely limb: bones longer or shorter than a body's, a displaced shoulder, an upper bone that points
// up.
double strain(const Figure& figure, int limb);

// The cost of two limbs that overlap so much (limbOverlap).
double sharingCost(double shared);

// A figure and how well it matches: the trunk, each limb, and the total, less the overlap of limbs.
struct MatchedFigure {
  Figure figure;
  double trunk = 0, total = 0;
  std::array<double, kFigureLimbs> limbs = {};
};

MatchedFigure matched(const FigureMatch& match, const Figure& figure);
// From the parts, as after limbs were exchanged.
void sumUp(MatchedFigure& matched);

}  // namespace limber
