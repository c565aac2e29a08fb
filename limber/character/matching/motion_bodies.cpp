#include "limber/character/matching/motion_bodies.h"

#include <algorithm>
#include <optional>
#include <string>
#include <utility>

#include <fmt/format.h>

#include "limber/character/anatomy/anatomy.h"
#include "limber/skeleton/chain.h"
#include "limber/skeleton/clip/tracks.h"

namespace limber {

namespace {

struct BodyGroups {
  Index fewJoints = 7;     // joints; 7 alone; of a body: a trunk, and two legs of three joints
  double together = 0.05;  // body sizes; 0.01 to 0.2; between hips of one body, over the clip; set by hand
  int moments = 16;        // frames of a clip; 8 to 100; at which hips are compared; set by hand
};
constexpr BodyGroups kBodyGroups;

// The joints that are kept, as numbers of the new skeleton.
using NewIndex = std::vector<std::optional<Index>>;  // #J

NewIndex indexBelow(const Skeleton& skeleton, Index root) {
  NewIndex kept(skeleton.jointCount());
  Index count = 0;
  for (Index j = 0; j < skeleton.jointCount(); ++j) {
    if (isAncestorOrSelf(skeleton, root, j) || isAncestorOrSelf(skeleton, j, root)) kept[j] = count++;
  }
  return kept;
}

Skeleton keptOf(const Skeleton& skeleton, const NewIndex& kept) {
  Skeleton part;
  part.boneShape = skeleton.boneShape;
  for (Index j = 0; j < skeleton.jointCount(); ++j) {
    if (!kept[j]) continue;
    Joint joint = skeleton.joints[j];
    if (joint.parent) joint.parent = kept[*joint.parent];
    part.joints.push_back(std::move(joint));
  }
  return part;
}

// A whole body: its root, where its legs begin, and its size.
struct Body {
  Index root = 0, leftHip = 0, rightHip = 0;
  double size = 0;

  Vec3 hips(const std::vector<Vec3>& positions) const { return 0.5 * (positions[leftHip] + positions[rightHip]); }
};

std::optional<Body> bodyBelow(const Skeleton& all, Index root) {
  const NewIndex kept = indexBelow(all, root);
  const Skeleton skeleton = keptOf(all, kept);
  if (skeleton.jointCount() < kBodyGroups.fewJoints) return std::nullopt;
  const Anatomy anatomy = readAnatomy(skeleton);
  const Part *left = anatomy.find(PartKind::kLeg, Side::kLeft), *right = anatomy.find(PartKind::kLeg, Side::kRight);
  const bool isStanding = left && right && std::min(left->confidence, right->confidence) >= kDoubtful;
  const bool isWhole = anatomy.find(PartKind::kTrunk) &&
                       (anatomy.find(PartKind::kHead) || anatomy.find(PartKind::kArm, Side::kLeft) ||
                        anatomy.find(PartKind::kWing, Side::kLeft) || anatomy.pairsOf(PartKind::kLeg) > 1);
  if (!isStanding || !isWhole) return std::nullopt;
  const auto inAll = [&](Index joint) {
    return static_cast<Index>(std::find(kept.begin(), kept.end(), joint) - kept.begin());
  };
  return Body{root, inAll(left->joints.front()), inAll(right->joints.front()), anatomy.size};
}

// Global positions at moments of the first clip, or of the rest pose.
std::vector<std::vector<Vec3>> positionsOf(const Motion& motion) {
  std::vector<std::vector<Vec3>> moments;
  const double duration = motion.clips.empty() ? 0 : motion.clips.front().duration();
  for (int i = 0; i < kBodyGroups.moments; ++i) {
    Pose pose = restPose(motion.skeleton);
    if (!motion.clips.empty()) sampleClip(motion.clips.front(), duration * i / (kBodyGroups.moments - 1), pose);
    moments.push_back(posePositions(motion.skeleton, pose));
  }
  return moments;
}

std::string listOf(const Motion& motion, const std::vector<Index>& roots) {
  std::string text;
  for (std::size_t i = 0; i < roots.size(); ++i) {
    text += i == 0 ? "" : i + 1 < roots.size() ? ", " : " and ";
    text += fmt::format("'{}'", motion.skeleton.joints[roots[i]].name);
  }
  return text;
}

std::optional<std::size_t> numberIn(std::string_view text) {
  constexpr std::size_t kMaxDigits = 6;  // digits; 1 to 9; more might not fit an unsigned long
  const bool isNumber = !text.empty() && text.size() <= kMaxDigits &&
                        std::all_of(text.begin(), text.end(), [](char c) { return c >= '0' && c <= '9'; });
  return isNumber ? std::optional<std::size_t>(std::stoul(std::string(text))) : std::nullopt;
}

}  // namespace

std::vector<Index> bodyRoots(const Motion& motion) {
  std::vector<Index> tops, roots;
  for (Index j = 0; j < motion.skeleton.jointCount(); ++j) {
    if (!motion.skeleton.joints[j].parent) tops.push_back(j);
  }
  if (tops.size() < 2) return tops;
  const std::vector<std::vector<Vec3>> moments = positionsOf(motion);
  std::vector<Body> bodies;
  for (const Index top : tops) {
    const std::optional<Body> body = bodyBelow(motion.skeleton, top);
    if (!body) continue;
    const auto goesWith = [&](const Body& other) {
      return std::all_of(moments.begin(), moments.end(), [&](const std::vector<Vec3>& positions) {
        return (body->hips(positions) - other.hips(positions)).norm() < kBodyGroups.together * body->size;
      });
    };
    if (std::none_of(bodies.begin(), bodies.end(), goesWith)) bodies.push_back(*body);
  }
  for (const Body& body : bodies) roots.push_back(body.root);
  return roots;
}

Motion motionBelow(const Motion& motion, Index root) {
  const NewIndex kept = indexBelow(motion.skeleton, root);
  Motion part = motion;
  part.skeleton = keptOf(motion.skeleton, kept);
  for (Clip& clip : part.clips) {
    forEachKind(clip, [&](auto& tracks) {
      std::erase_if(tracks, [&](const auto& track) { return !kept[track.joint]; });
      for (auto& track : tracks) track.joint = *kept[track.joint];
    });
  }
  return part;
}

Motion motionOfBody(const Motion& motion, std::string_view body) {
  if (const std::optional<Index> joint = motion.skeleton.find(body); joint && !body.empty())
    return motionBelow(motion, *joint);
  const std::vector<Index> roots = bodyRoots(motion);
  if (body.empty()) {
    if (roots.size() < 2) return motion;
    throw Error(ErrorCode::kUnsupported,
                fmt::format("holds {} bodies, below the root joints {}", roots.size(), listOf(motion, roots)),
                motion.name,
                fmt::format("--skeleton '{}' takes that one alone", motion.skeleton.joints[roots.front()].name));
  }
  const std::optional<std::size_t> number = numberIn(body);
  if (number && *number >= 1 && *number <= roots.size()) return motionBelow(motion, roots[*number - 1]);
  throw Error(ErrorCode::kBadArgument, fmt::format("has no joint '{}'", body), motion.name,
              roots.empty() ? "name the root joint of one of its bodies"
                            : fmt::format("its {} below {}", roots.size() == 1 ? "body is" : "bodies are",
                                          listOf(motion, roots)));
}

}  // namespace limber
