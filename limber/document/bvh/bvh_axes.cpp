#include "limber/document/bvh/bvh_axes.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <vector>

#include <fmt/format.h>

namespace limber {

namespace {

// Rise over run from feet to head: people are within a few degrees of upright; a beast's head lies before its feet,
// too.
constexpr double kUprightSlope = 4;
// That are looked at: more of a long recording tell nothing new, and a file may have joints without channels.
constexpr std::size_t kMaxSampledFrames = 2000, kMaxPositions = 4000000;
constexpr double kAbout = 0.7;  // cosine of 45 degrees, about
// Fractions of the frames. A recording that is upright along one axis in a tenth of them does not have its other axis
// up.
constexpr double kMinAlongOther = 0.5, kMaxAlongExpected = 0.1, kNearlyAll = 0.98;
// In FramePostures::size. Of walks, runs, jumps and dances of the shared motions the deviation of the lowest point is
// 0.002 to 0.09 along up and 0.02 to 0.9 along the level axes.
constexpr double kTravels = 0.25;   // deviation of a body that goes somewhere: arms that swing on the spot make less
constexpr double kSteady = 0.5;     // fraction of the other axis's deviation below which the ground is clear
constexpr double kMinMoves = 0.02;  // a deviation that is not only breath and noise
constexpr double kGround = 0.05;    // distance of soles from a ground at 0
constexpr double kOffGround = 0.1;  // distance from 0 of the lowest point of a body that does not lie on such a ground

int indexOf(UpAxis axis) {
  return axis == UpAxis::kY || axis == UpAxis::kMinusY ? 1 : 2;
}

double meanHeight(std::span<const Vec3> positions, std::span<const Index> joints) {
  double sum = 0;
  for (const Index joint : joints) sum += positions[joint].y();
  return sum / static_cast<double>(joints.size());
}

// The lowest joint of the tree that has all heads and feet below it or is one of them.
std::optional<Index> carrierOfAll(std::span<const BvhJoint> joints, const BvhEnds& ends) {
  std::vector<std::size_t> below(joints.size(), 0);
  for (const std::vector<Index>* list : {&ends.heads, &ends.feet}) {
    for (const Index joint : *list) ++below[joint];
  }
  for (std::size_t j = joints.size(); j-- > 0;) {
    if (joints[j].parent) below[*joints[j].parent] += below[j];
  }
  for (std::size_t j = joints.size(); j-- > 0;) {
    if (below[j] == ends.heads.size() + ends.feet.size()) return static_cast<Index>(j);
  }
  return std::nullopt;
}

}  // namespace

bool restsAlong(UpAxis up, std::span<const BvhJoint> joints, const BvhEnds& ends) {
  if (!ends.known()) return false;
  std::vector<Vec3> positions = restPositionsOf(joints);
  for (Vec3& position : positions) turnUpright(position, up);
  const Vec3 upwards = ends.upwards(positions);
  if (const std::optional<Index> carrier = carrierOfAll(joints, ends)) {
    const double height = positions[*carrier].y();
    if (meanHeight(positions, ends.heads) < height || meanHeight(positions, ends.feet) > height) return false;
  }
  return upwards.y() > kUprightSlope * std::hypot(upwards.x(), upwards.z());
}

bool isUprightAlongZ(std::span<const BvhJoint> joints) {
  return restsAlong(UpAxis::kZ, joints, namedEnds(joints));
}

bool headsLieAhead(std::span<const BvhJoint> joints, const BvhEnds& ends) {
  if (!ends.known()) return false;
  const Vec3 upwards = ends.upwards(restPositionsOf(joints));
  return upwards.z() > std::abs(upwards.y()) && upwards.z() <= kUprightSlope * std::hypot(upwards.x(), upwards.y());
}

void HeadDirections::add(const Vec3& upwards) {
  ++frames_;
  for (std::size_t axis = 0; axis < along_.size(); ++axis) {
    Vec3 turned = upwards;
    turnUpright(turned, static_cast<UpAxis>(axis));
    along_[axis] += turned.y() > kAbout * upwards.norm();
  }
}

double HeadDirections::fractionAlong(UpAxis axis) const {
  if (frames_ == 0) return 0;
  return static_cast<double>(along_[static_cast<std::size_t>(axis)]) / static_cast<double>(frames_);
}

bool HeadDirections::isUpsideDown(UpAxis up) const {
  return fractionAlong(opposite(up)) > kNearlyAll;
}

FramePostures framePostures(const Motion& motion, const BvhEnds& ends) {
  FramePostures postures;
  if (motion.clips.empty() || !ends.known()) return postures;
  const Clip& clip = motion.clips.front();
  const std::size_t count = frameCount(clip, motion.framesPerSecond);
  const std::size_t joints = motion.skeleton.jointCount();
  const std::size_t most = std::clamp<std::size_t>(kMaxPositions / joints, 1, kMaxSampledFrames);
  const std::size_t step = (count + most - 1) / most;
  Vec3 sum = Vec3::Zero(), squares = Vec3::Zero();
  postures.lowest.setConstant(std::numeric_limits<double>::infinity());
  Pose pose = restPose(motion.skeleton);
  for (std::size_t f = 0; f < count; f += step) {
    sampleClip(clip, static_cast<double>(f) / motion.framesPerSecond, pose);
    const std::vector<Vec3> positions = posePositions(motion.skeleton, pose);
    const Vec3 upwards = ends.upwards(positions);
    const double size = upwards.norm();
    if (!(size > 0)) continue;
    Vec3 lowest = positions.front();
    for (const Vec3& position : positions) lowest = lowest.cwiseMin(position);
    ++postures.frames;
    postures.upwards += upwards / size;
    postures.heads.add(upwards);
    postures.size = std::max(postures.size, size);
    postures.lowest = postures.lowest.cwiseMin(lowest);
    sum += lowest;
    squares += lowest.cwiseAbs2();
  }
  if (postures.frames == 0) return postures;
  const double frames = static_cast<double>(postures.frames);
  postures.upwards /= frames;
  postures.lowestDeviation = (squares / frames - (sum / frames).cwiseAbs2()).cwiseMax(0).cwiseSqrt();
  return postures;
}

FramesUp upOfFrames(const FramePostures& postures, UpAxis expected) {
  if (postures.frames == 0) return {expected, false};
  const UpAxis other = expected == UpAxis::kY ? UpAxis::kZ : UpAxis::kY;
  const int e = indexOf(expected), o = indexOf(other);
  if (!(postures.upwards[o] > postures.upwards[e]) || postures.heads.fractionAlong(other) < kMinAlongOther)
    return {expected, false};

  const Vec3 lowest = postures.lowest / postures.size, deviation = postures.lowestDeviation / postures.size;
  const bool steadyAlongOther = deviation[o] < kSteady * deviation[e];
  if (steadyAlongOther && deviation[e] > kTravels) return {other, false};
  if (deviation[e] < kSteady * deviation[o] && deviation[o] > kMinMoves) return {expected, false};
  if (postures.heads.fractionAlong(expected) > kMaxAlongExpected) return {expected, false};
  const bool groundOfOther = std::abs(lowest[o]) < kGround && std::abs(lowest[e]) > kOffGround;
  if (groundOfOther && (steadyAlongOther || deviation[o] < kMinMoves)) return {other, false};
  return {expected, true};
}

std::string upsideDownMessage(UpAxis up) {
  return fmt::format("the head is below the feet in all frames: where that is not meant, read the file with --up={}",
                     nameOf(opposite(up)));
}

std::string convertedAxesMessage(UpAxis up) {
  std::string axis(nameOf(up));
  axis.back() = up == UpAxis::kZ || up == UpAxis::kMinusZ ? 'Z' : 'Y';
  return fmt::format("files with {} up are turned to Y up", axis);
}

}  // namespace limber
