// Loops are looked for by brute force: clips are short, and a wrong loop shows at once.
#include <algorithm>
#include <cmath>
#include <limits>
#include <span>

#include "limber/skeleton/clip/clip_edit.h"
#include "limber/skeleton/motion.h"

namespace limber {

namespace {

constexpr double kMaxLoopFrames = 1500;
constexpr double kMinLoop = 0.4;  // seconds
constexpr double kStill = 1e-4;   // of the skeleton's size: less movement than this is none

// The joints that the body travels with: all but those above it, which may stay where they are.
std::vector<Index> travellers(const Skeleton& skeleton, Index body) {
  std::vector<bool> above(skeleton.jointCount(), false);
  for (std::optional<Index> j = skeleton.joints[body].parent; j; j = skeleton.joints[*j].parent) above[*j] = true;
  std::vector<Index> joints;
  for (Index j = 0; j < skeleton.jointCount(); ++j) {
    if (!above[j]) joints.push_back(j);
  }
  return joints;
}

// Positions of joints with the body's position on the ground and its heading (rotation about +Y) taken out.
std::vector<Vec3> standingPoints(const Skeleton& skeleton, const Clip& clip, std::span<const Index> joints, Index body,
                                 const Quat& rest, double seconds) {
  Pose pose = restPose(skeleton);
  sampleClip(clip, seconds, pose);
  const std::vector<Affine> globals = poseGlobals(skeleton, pose);
  std::vector<Vec3> points;
  for (const Index j : joints) points.push_back(globals[j].translation());
  const Quat turn(decompose(globals[body]).rotation);
  const Quat since = turn * rest.inverse();
  const double heading = 2 * std::atan2(since.y(), since.w());  // the twist about +Y
  const Eigen::AngleAxisd back(-heading, Vec3::UnitY());
  const Vec3 position = globals[body].translation(), origin(position.x(), 0, position.z());
  for (Vec3& point : points) point = back * (point - origin);
  return points;
}

double meanSquare(const std::vector<Vec3>& a, const std::vector<Vec3>& b) {
  double sum = 0;
  for (std::size_t j = 0; j < a.size(); ++j) sum += (a[j] - b[j]).squaredNorm();
  return sum / static_cast<double>(a.size());
}

}  // namespace

std::optional<ClipLoop> findLoop(const Skeleton& skeleton, const Clip& clip, const LoopOptions& options) {
  const double duration = clip.duration();
  if (options.body >= skeleton.jointCount() || duration < kMinLoop) return std::nullopt;
  const Quat rest(decompose(restGlobals(skeleton)[options.body]).rotation);
  const double rate = std::min(options.framesPerSecond, kMaxLoopFrames / duration);
  const Index frames = frameCount(clip, rate);
  const std::vector<Index> joints = travellers(skeleton, options.body);
  std::vector<std::vector<Vec3>> poses;
  for (Index k = 0; k < frames; ++k) {
    poses.push_back(standingPoints(skeleton, clip, joints, options.body, rest, std::min(k / rate, duration)));
  }
  Box box;
  double movement = 0;
  for (const Affine& global : restGlobals(skeleton)) box.add(global.translation());
  for (const auto& pose : poses) movement = std::max(movement, meanSquare(poses.front(), pose));
  const double size = box.diagonal();
  if (!(size > 0) || std::sqrt(movement) < kStill * size) return std::nullopt;

  const auto shortest = static_cast<Index>(std::max(2.0, std::ceil(kMinLoop * rate)));
  std::optional<ClipLoop> best;
  double bestCost = std::numeric_limits<double>::infinity();
  for (Index i = 0; i + 1 < frames; ++i) {
    for (Index k = i + shortest; k < frames; ++k) {
      // At the clip's end there is no next frame: then the ones before are compared.
      const Index step = k + 1 < frames ? 1 : 0;
      double square = meanSquare(poses[i], poses[k]);
      if (step == 1) square = 0.5 * (square + meanSquare(poses[i + 1], poses[k + 1]));
      const double error = std::sqrt(square) / size;
      if (error > options.largestError) continue;
      const double cost = (error + 1e-4) / (k - i);
      if (cost >= bestCost) continue;
      bestCost = cost;
      best = ClipLoop{i / rate, std::min(k / rate, duration), error};
    }
  }
  return best;
}

}  // namespace limber
