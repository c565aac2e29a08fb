#include "limber/document/bvh/bvh_write.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <iterator>
#include <limits>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "limber/core/known_error.h"
#include "limber/core/sort_unique.h"
#include "limber/core/text/numbers.h"
#include "limber/core/text/printable.h"
#include "limber/skeleton/chain.h"
#include "limber/skeleton/clip/tracks.h"

namespace limber {

namespace {

constexpr double kDenseRate = 60, kMaxRate = 240;                  // frames a second
constexpr double kTimeRounding = 2e-6;                             // of a time in single precision
constexpr std::uint64_t kMaxJointFrames = std::uint64_t{1} << 24;  // joints x frames of a file: some 500 MB of text
constexpr std::string_view kEndSite = "_end";
constexpr double kMoved = 1e-6;  // of the skeleton's size: a joint farther from its offset gets position channels

// The angles of R = Z(a[0]) X(a[1]) Y(a[2]) in degrees; of the two solutions, and whole turns, the nearest to `before`.
using Angles = std::array<double, 3>;

double nearestTurn(double degrees, double before) {
  return degrees + 360 * std::round((before - degrees) / 360);
}

Angles anglesNear(const Mat3& r, const Angles& before) {
  constexpr double kDegrees = 180 / kPi;
  constexpr double kStraight = 1e-9;  // cosine of X: Z and Y turn about one axis
  const double sx = std::clamp(r(2, 1), -1.0, 1.0), cx = std::hypot(r(0, 1), r(1, 1));
  if (cx < kStraight) {  // Y stays what it was
    const double x = sx > 0 ? 90 : -90;
    const double y = before[2], sum = std::atan2(r(1, 0), r(0, 0)) * kDegrees;
    return {nearestTurn(sx > 0 ? sum - y : sum + y, before[0]), nearestTurn(x, before[1]), y};
  }
  const double z = std::atan2(-r(0, 1), r(1, 1)) * kDegrees, x = std::atan2(sx, cx) * kDegrees;
  const double y = std::atan2(-r(2, 0), r(2, 2)) * kDegrees;
  const Angles first = {nearestTurn(z, before[0]), nearestTurn(x, before[1]), nearestTurn(y, before[2])};
  const Angles second = {nearestTurn(z + 180, before[0]), nearestTurn(180 - x, before[1]),
                         nearestTurn(y + 180, before[2])};
  const auto distance = [&](const Angles& a) {
    return std::abs(a[0] - before[0]) + std::abs(a[1] - before[1]) + std::abs(a[2] - before[2]);
  };
  return distance(first) <= distance(second) ? first : second;
}

// What a joint is in the file: its frame is the world's in rest pose.
struct BvhJointFrame {
  Vec3 position = Vec3::Zero();      // from the parent, in the parent's frame
  Mat3 rotation = Mat3::Identity();  // likewise
};

class BvhWriter {
 public:
  BvhWriter(const Motion& motion, const BvhWriteOptions& options)
      : skeleton_(motion.skeleton), clip_(motion.clips[options.clip]), unit_(options.metresPerUnit) {
    const double rate = options.fps ? *options.fps : bvhFrameRate(motion, options.clip);
    frames_ = frameCount(clip_, rate);
    secondsPerFrame_ = 1 / rate;
    checkSize();
    children_ = childrenOf(skeleton_);
    restGlobals_ = restGlobals(skeleton_);
    for (const Affine& global : restGlobals_) toRest_.push_back(decompose(global).rotation.inverse());
    findEnds();
    findMoved();
  }

  Bytes write() {
    out("HIERARCHY\n");
    for (Index j = 0; j < skeleton_.jointCount(); ++j) {
      if (!skeleton_.joints[j].parent) writeJoint(j);
    }
    out("MOTION\nFrames: {}\nFrame Time: {:.10g}\n", frames_, secondsPerFrame_);
    std::vector<Angles> angles(skeleton_.jointCount(), Angles{});
    for (Index k = 0; k < frames_; ++k) writeFrame(framesAt(k), angles);
    return std::move(bytes_);
  }

 private:
  template <typename... Arguments>
  void out(fmt::format_string<Arguments...> text, Arguments&&... arguments) {
    fmt::format_to(std::back_inserter(bytes_), text, std::forward<Arguments>(arguments)...);
  }

  // A chain may be as long as the file; its indentation must not be.
  void indent(std::size_t depth) { bytes_.insert(bytes_.end(), std::min(depth, kDeepestIndentation), '\t'); }

  // Without zeros at the end, and without an exponent: not every reader knows it.
  void outNumber(double value, int decimals) {
    std::string text = fmt::format("{:.{}f}", value, decimals);
    if (text.find('.') != std::string::npos) {
      while (text.back() == '0') text.pop_back();
      if (text.back() == '.') text.pop_back();
    }
    out(" {}", text == "-0" ? "0" : text);
  }

  // As many digits as single precision has.
  void outLength(double length) {
    if (!(std::abs(length) <= std::numeric_limits<float>::max())) {
      throw Error(ErrorCode::kLimit, "a joint is further away than a BVH can say", shortened(clip_.name));
    }
    int decimals = kLengthDigits;
    for (double power = 1; decimals > 0 && std::abs(length) >= power; power *= 10) --decimals;
    outNumber(length, decimals);
  }

  // Throws before memory or time is asked for.
  void checkSize() const {
    const std::uint64_t joints = skeleton_.jointCount();
    if (joints * frames_ <= kMaxJointFrames) return;
    throw Error(ErrorCode::kLimit, fmt::format("{} joints in {} frames are too many for a BVH file", joints, frames_),
                fmt::format("clip '{}'", shortened(clip_.name)), "choose a lower --fps or a part of the clip");
  }

  void findEnds() {
    std::vector<bool> moved(skeleton_.jointCount(), false);
    forEachTrack(clip_, [&](const auto& track) { moved[track.joint] = true; });
    for (Index j = 0; j < skeleton_.jointCount(); ++j) {
      const Joint& joint = skeleton_.joints[j];
      const bool named = joint.name.size() > kEndSite.size() &&
                         std::string_view(joint.name).substr(joint.name.size() - kEndSite.size()) == kEndSite;
      isEnd_.push_back(joint.parent && children_[j].empty() && named && !moved[j]);
      if (joint.name.find_first_of("\r\n{}") != std::string::npos) {
        throw KnownError(ErrorKind::kNoBvhName,
                         {ErrorCode::kBadArgument, "its name cannot stand in a BVH file",
                          fmt::format("joint '{}'", shortened(joint.name)), "rename the joint"},
                         {{"joint", joint.name}});
      }
    }
  }

  void findMoved() {
    Box box;
    for (const Affine& global : restGlobals_) box.add(global.translation());
    const double tolerance = kMoved * box.diagonal();
    hasPosition_.assign(skeleton_.jointCount(), false);
    for (Index k = 0; k < frames_; ++k) {
      const std::vector<BvhJointFrame> joints = framesAt(k);
      for (Index j = 0; j < joints.size(); ++j) {
        const bool moves = !skeleton_.joints[j].parent || (joints[j].position - offsetOf(j)).norm() > tolerance;
        hasPosition_[j] = hasPosition_[j] || (moves && !isEnd_[j]);
      }
    }
  }

  Vec3 offsetOf(Index j) const {
    const Vec3 position = restGlobals_[j].translation();
    const std::optional<Index> parent = skeleton_.joints[j].parent;
    return parent ? Vec3(position - restGlobals_[*parent].translation()) : position;
  }

  std::vector<BvhJointFrame> framesAt(Index frame) const {
    Pose pose = restPose(skeleton_);
    sampleClip(clip_, std::min(frame * secondsPerFrame_, clip_.duration()), pose);
    const std::vector<Affine> globals = poseGlobals(skeleton_, pose);
    std::vector<Mat3> turns(globals.size());
    std::vector<BvhJointFrame> result(globals.size());
    for (Index j = 0; j < globals.size(); ++j) {
      turns[j] = (decompose(globals[j]).rotation * toRest_[j]).toRotationMatrix();
      const std::optional<Index> parent = skeleton_.joints[j].parent;
      if (!parent) {
        result[j] = {globals[j].translation(), turns[j]};
        continue;
      }
      const Mat3 back = turns[*parent].transpose();
      result[j] = {back * (globals[j].translation() - globals[*parent].translation()), back * turns[j]};
    }
    return result;
  }

  // The tree below a root, depth first, without recursion: a chain may be as long as the file.
  void writeJoint(Index root) {
    std::vector<std::pair<Index, std::size_t>> open;  // joint, children written
    openJoint(root, 0);
    open.emplace_back(root, 0);
    while (!open.empty()) {
      auto& [joint, written] = open.back();
      if (written < children_[joint].size()) {
        const Index child = children_[joint][written++];
        const std::size_t depth = open.size();
        if (isEnd_[child]) {
          writeEnd(offsetOf(child), depth);
        } else {
          openJoint(child, depth);
          open.emplace_back(child, 0);
        }
        continue;
      }
      if (children_[joint].empty()) writeEnd(Vec3::Zero(), open.size());
      open.pop_back();
      indent(open.size());
      out("}}\n");
    }
  }

  void openJoint(Index j, std::size_t depth) {
    order_.push_back(j);
    const Joint& joint = skeleton_.joints[j];
    indent(depth);
    out("{} {}\n", joint.parent ? "JOINT" : "ROOT", joint.name);
    indent(depth);
    out("{{\n");
    writeOffset(offsetOf(j), depth + 1);
    indent(depth + 1);
    out("CHANNELS {} Zrotation Xrotation Yrotation\n", hasPosition_[j] ? "6 Xposition Yposition Zposition" : "3");
  }

  void writeEnd(const Vec3& offset, std::size_t depth) {
    indent(depth);
    out("End Site\n");
    indent(depth);
    out("{{\n");
    writeOffset(offset, depth + 1);
    indent(depth);
    out("}}\n");
  }

  void writeOffset(const Vec3& offset, std::size_t depth) {
    indent(depth);
    out("OFFSET");
    for (int i = 0; i < 3; ++i) outLength(offset[i] / unit_);
    out("\n");
  }

  void writeFrame(const std::vector<BvhJointFrame>& joints, std::vector<Angles>& angles) {
    for (const Index j : order_) {
      for (int i = 0; hasPosition_[j] && i < 3; ++i) outLength(joints[j].position[i] / unit_);
      angles[j] = anglesNear(joints[j].rotation, angles[j]);
      for (const double angle : angles[j]) outNumber(angle, kAngleDecimals);
    }
    out("\n");
  }

  static constexpr int kLengthDigits = 7, kAngleDecimals = 6;
  static constexpr std::size_t kDeepestIndentation = 32;

  const Skeleton& skeleton_;
  const Clip& clip_;
  double unit_, secondsPerFrame_ = 0;
  Index frames_ = 0;
  std::vector<std::vector<Index>> children_;
  std::vector<Affine> restGlobals_;
  std::vector<Quat> toRest_;  // #J inverses of the rest rotations
  std::vector<bool> isEnd_, hasPosition_;
  std::vector<Index> order_;  // of the channels
  Bytes bytes_;
};

}  // namespace

double bvhFrameRate(const Motion& motion, std::size_t clip) {
  constexpr int kMaxRefinement = 16;
  constexpr double kOnFrame = 0.02;  // of a frame
  const double rate = frameRateOf(motion, clip), finest = std::max(rate, kDenseRate);
  std::vector<float> times;
  const auto addTimes = [&](const auto& tracks) {
    for (const auto& track : tracks) times.insert(times.end(), track.times.begin(), track.times.end());
  };
  addTimes(motion.clips[clip].translations);
  addTimes(motion.clips[clip].rotations);
  sortUnique(times);
  if (times.size() > 2) times.pop_back();  // a clip may end between two frames
  for (int finer = 1; finer <= kMaxRefinement && finer * rate <= kMaxRate; ++finer) {
    const auto isFrame = [&](float time) {
      const double frames = double{time} * finer * rate;
      return std::abs(frames - std::round(frames)) <= kOnFrame + kTimeRounding * frames;
    };
    if (std::all_of(times.begin(), times.end(), isFrame)) return finer * rate;
  }
  return rate * std::ceil(finest / rate);
}

Bytes writeBvh(const Motion& motion, const BvhWriteOptions& options) {
  checkMotion(motion);
  if (options.clip >= motion.clips.size() || motion.skeleton.joints.empty()) {
    throw Error(ErrorCode::kBadArgument, "the motion has no such clip");
  }
  if (!(options.metresPerUnit > 0) || !std::isfinite(options.metresPerUnit)) {
    throw Error(ErrorCode::kBadArgument, fmt::format("a unit cannot be {:g} metres", options.metresPerUnit));
  }
  return BvhWriter(motion, options).write();
}

}  // namespace limber
