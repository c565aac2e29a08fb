// How rough a body moves, so that bodies of other proportions can be compared.
#pragma once

#include <array>
#include <vector>

#include "limber/character/matching/retarget_setup.h"

namespace limber {

// Joints of an arm or a leg that both skeletons have: the upper, the lower and the end, as far as they are matched.
struct LimbPair {
  std::vector<Index> source, target;

  const std::vector<Index>& of(MapSide side) const { return side == MapSide::kSource ? source : target; }
};
// A person, or an animal with legs that both skeletons have.
bool hasLegs(const RetargetSetup& setup);

// Of people arms and legs, of others RetargetSetup::animalLegs; without legs all bones from a matched joint to the
// next, and chains of several from end to end.
std::vector<LimbPair> limbPairs(const RetargetSetup& setup);

// From the lowest foot joint to the head's, of a person; of others to the highest joint that is matched; without legs
// the size of the body (RetargetSetup::sourceHipHeight): metres.
double standingHeight(const RetargetSetup& setup, MapSide side);

using Path = std::vector<Vec3>;  // of a point, frame by frame

// The pelvis over the hips' height, and of each limb the bones, each as the displacement from its joint to the next
// over its length at rest: the same angles on other proportions have the same paths (Hogan, Sternad 2009).
class BodyPaths {
 public:
  // `setup` must outlive this.
  BodyPaths(const RetargetSetup& setup, MapSide side) : BodyPaths(setup, side, neutralOf(setup, side).restPositions) {}
  // Bones' lengths by other `rest` positions, #J.
  BodyPaths(const RetargetSetup& setup, MapSide side, const std::vector<Vec3>& rest);

  // The next frame: #J positions, in the person's space.
  void add(const std::vector<Vec3>& positions);
  // The pelvis first, then the limbs' bones in limbPairs' order.
  const std::vector<Path>& paths() const { return paths_; }

 private:
  struct Bone {
    Index from = 0, to = 0;
    double length = 1;
  };
  static const NeutralPose& neutralOf(const RetargetSetup& setup, MapSide side) {
    return side == MapSide::kSource ? setup.sourceNeutral : setup.targetNeutral;
  }

  const RetargetSetup* setup_;
  MapSide side_;
  std::vector<Bone> bones_;
  std::vector<Path> paths_;
};

// Whether any matched joint is faster from one frame to the next than bodies move: the source's positions, #J.
bool isCut(const RetargetSetup& setup, const std::vector<Vec3>& before, const std::vector<Vec3>& now, double seconds);

// Whether the third difference that ends in frame `f` is that of a motion: not across a cut, nor before the start.
bool isWhole(const std::vector<bool>& cuts, std::size_t f);
// Factors of the values from three frames back to the frame itself: fixed, what a third difference is.
inline constexpr std::array<double, 4> kThirdDifference = {-1, 3, -3, 1};
Vec3 thirdDifference(const Path& path, std::size_t f);
// Sum of the squared whole third differences that end in the frames [begin, end).
double squaredJerk(const Path& path, const std::vector<bool>& cuts, std::size_t begin, std::size_t end);
double squaredJerk(const std::vector<Path>& paths, const std::vector<bool>& cuts, std::size_t begin, std::size_t end);
// Root mean square jerk of the target against the source's, from the sums over as many frames. 1 where neither moves;
// what hardly moves counts as a little rough.
double jerkRatio(double source, double target, std::size_t frames);
// How often squared third differences count against squared changes, for changes that come and go in `seconds`
// (Whittaker's smoothing, of order three).
double smoothnessWeight(double seconds, double frameSeconds);

}  // namespace limber
