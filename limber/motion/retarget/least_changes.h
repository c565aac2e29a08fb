// The least change of pelvis and feet over a whole motion that does what is asked of it: one banded least squares, to
// first order. Planting feet (refineSpacetime) and motion smoothing (smoothMotion) are two sets of weights.
#pragma once

#include <array>
#include <vector>

#include "limber/core/types.h"
#include "limber/motion/limbs/roughness.h"
#include "limber/motion/retarget/band_matrix.h"

namespace limber {

// Of each frame: the displacement of the pelvis, that of each foot, and how far the shoulders rise where the trunk
// tilts, all in hip heights. Their order in one column.
class ChangeLayout {
 public:
  ChangeLayout() = default;
  // `tilted`: of each leg whether its hip is at shoulders that rise.
  ChangeLayout(std::size_t frames, std::vector<bool> tilted);

  std::size_t frames() const { return frames_; }
  std::size_t legs() const { return tilted_.size(); }
  bool isTilted(std::size_t leg) const { return tilted_[leg]; }
  bool tilts() const { return tilts_; }
  std::size_t perFrame() const { return perFrame_; }
  std::size_t pelvis(std::size_t frame) const { return frame * perFrame_; }
  std::size_t foot(std::size_t frame, std::size_t leg) const { return pelvis(frame) + 3 * (1 + leg); }
  std::size_t shoulders(std::size_t frame) const { return foot(frame, legs()); }

 private:
  std::size_t frames_ = 0, perFrame_ = 0;
  std::vector<bool> tilted_;
  bool tilts_ = false;
};
using Changes = std::vector<double>;  // by such a layout

// Frames; 200 to 10000; about so many of a motion are in one solve: bounds memory; set by hand.
inline constexpr std::size_t kPartFrames = 1000;
// Frames that a part has in common with another: third differences reach no further.
inline constexpr std::size_t kJoinedFrames = kThirdDifference.size() - 1;

Vec3 displacementAt(const Changes& changes, std::size_t first);

// What has to hold for a foot in one frame.
struct FootFrame {
  bool planted = false;
  double lowest = 0;                 // change of its height, at most 0: hip heights
  Vec3 displacement = Vec3::Zero();  // from the hip, likewise
  double most = 0;                   // that its leg reaches, likewise
  Vec3 lift = Vec3::Zero();          // of its hip, for each hip height that the shoulders rise
  Vec3 step = Vec3::Zero();          // level change from the frame before that `hold` asks for, likewise
  double hold = 0;                   // how firmly, 0 to 1
  double height = 0;                 // change of its height that `rest` asks for, likewise
  double rest = 0;                   // how firmly, 0 to 1
};

// What counts how much, against each other: changes in hip heights, bones in their lengths, each squared.
struct ChangeWeights {
  double pelvisLevel = 1, pelvisUp = 1;  // changes of the pelvis, and the rise of shoulders; up where feet carry them
  double feet = 1;                       // changes of feet
  double bones = 0;                      // changes of the directions of legs' bones
  double hold = 0, rest = 0;             // FootFrame's
  int rounds = 3;                        // of looking for bounds that are met
};

// How a bone's direction follows its foot's position (the first three columns) and the shoulders' rise.
using Slope = Eigen::Matrix<double, 3, 4>;
using BoneSlopes = std::array<std::vector<Slope>, 2>;  // of a leg's two bones, frame by frame

// The motion as it is with some changes: the paths of what they move, as BodyPaths has them.
struct ChangedMotion {
  Changes changes;
  std::vector<Path> paths;         // of the pelvis, then of each leg's two bones
  std::vector<BoneSlopes> slopes;  // of each leg

  const Path& bone(std::size_t leg, std::size_t which) const { return paths[1 + 2 * leg + which]; }
};

// Which frames keep still: the first and the last three where others follow that stay; where the motion loops the first
// frame changes as the last one does.
struct MotionEnds {
  bool startsJoined = false, endsJoined = false, loops = false;
  Changes start = {};  // of the first three where they are not 0
};

class LeastChanges {
 public:
  // Feet of each frame, of each leg; cuts by frame.
  LeastChanges(const ChangeLayout& layout, std::vector<FootFrame> feet, std::vector<bool> cuts, MotionEnds ends,
               const ChangeWeights& weights = {});

  // The motion with the changes that are, about which bones are seen to first order.
  void start(const ChangedMotion& now);
  // The least sum of all that counts and of `jerkWeight` times the squared jerk: planted feet take no steps, none goes
  // below its lowest nor beyond its leg. n (perFrame * 4)^2 operations a few times.
  Changes find(double jerkWeight);

 private:
  // Which of its bounds constrain a foot in one frame: those met while solving for the changes.
  struct Pinned {
    bool up = false, near = false;
  };
  using Term = BandLeastSquares::Term;

  const FootFrame& foot(std::size_t frame, std::size_t leg) const { return feet_[frame * layout_.legs() + leg]; }
  bool isPinned(std::size_t frame) const;
  void countThirds();
  void addOwnChanges(std::size_t frame);
  double supportOf(std::size_t frame, bool shoulders) const;
  void addFoot(std::size_t frame, std::size_t leg);
  void holdPlanted(double weight);
  void addPelvisJerk(const ChangedMotion& now);
  void addBones(std::size_t leg, const ChangedMotion& now);
  void addBlock(std::size_t leg, std::size_t frame, std::size_t back, const Eigen::Matrix4d& block,
                BandLeastSquares& squares);
  void pullThirds();
  void closeLoop(double weight, const Changes& changes);
  // False where no bound is met that was not before.
  bool meetBounds(const Changes& changes);
  void holdBounds(double weight, const Changes& about);
  Vec3 legAt(const Changes& changes, std::size_t frame, std::size_t leg) const;

  ChangeLayout layout_;
  std::vector<FootFrame> feet_;
  std::vector<bool> cuts_;
  MotionEnds ends_;
  ChangeWeights weights_;
  std::vector<Pinned> pinned_;
  // How often each frame meets one so many frames back in the sum of the squared third differences.
  std::vector<std::array<double, 4>> meets_;
  Changes start_;
  // The squared jerk alone, the changes alone, then all but bounds, then all.
  BandLeastSquares jerk_, closeness_, unbound_, squares_;
  std::vector<Vec3> values_, thirds_;  // of one path
};

}  // namespace limber
