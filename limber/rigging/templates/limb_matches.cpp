#include "limber/rigging/templates/limb_matches.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "limber/rigging/templates/figure_fit.h"

namespace limber {

namespace {

constexpr double kNoMatch = 2.1;                    // mean cost of a limb's joints; up to 1.2 on people, 2 on toys
constexpr double kSunken = 2, kSunkenDepth = 0.01;  // of the other side's depth, and heights more
constexpr double kThinnest = 0.005;                 // heights that limbs are deep, at least
// Least distance of a head's top above the shoulders, over that from the hips to these: 0.35 and more on people and
// robots, up to 0.2 where the head is cut off.
constexpr double kMinHead = 0.28;
constexpr double kWithin = 0.04;  // heights
constexpr double kAcross = 0.5;   // most cosine between a limb and what lies across from it

// Whether the straight path from the limb's last joint but the tip across to that of the other side stays inside the
// body. A path along the limbs may: from hand to hand of stretched arms it does.
bool hasCommonEnd(const TemplateSkeleton& skeleton, const TemplateLimb& limb, const std::vector<Vec3>& positions,
                  const BodyVolume& body, const AnatomicalFrame& frame) {
  constexpr int kSteps = 24;
  const std::size_t count = limb.placed.size();
  if (count < 3 || skeleton.joints[limb.placed.back()].role != TemplateRole::kTip) return false;
  const Index end = limb.placed[count - 2];
  const std::optional<Index> mirror = skeleton.joints[end].mirror;
  if (!mirror || *mirror == end) return false;
  const Vec3 displacement = positions[*mirror] - positions[end],
             bone = positions[end] - positions[limb.placed[count - 3]];
  if (std::abs(displacement.dot(bone)) > kAcross * displacement.norm() * bone.norm()) return false;
  for (int step = 0; step <= kSteps; ++step) {
    const Vec3 position = positions[end] + static_cast<double>(step) / kSteps * displacement;
    if (body.distance->at(frame.fromBody(position)) > 0) return false;
  }
  return true;
}

// Whether half of a limb's joints and more, but for the first, lie on bones of other limbs.
bool liesInAnother(const TemplateSkeleton& skeleton, const TemplateLimb& limb, const std::vector<Vec3>& positions) {
  // Bones of the limb and of all that hangs on it.
  std::vector<bool> own(skeleton.jointCount(), false);
  for (const Index j : limb.joints) own[j] = true;
  for (Index j = 0; j < skeleton.jointCount(); ++j) {
    if (skeleton.joints[j].parent && own[*skeleton.joints[j].parent]) own[j] = true;
  }
  std::size_t within = 0;
  for (std::size_t k = 1; k < limb.placed.size(); ++k) {
    const Vec3& position = positions[limb.placed[k]];
    for (Index j = 0; j < skeleton.jointCount(); ++j) {
      const std::optional<Index> parent = skeleton.joints[j].parent;
      if (!parent || own[j]) continue;
      if (distanceToBone(position, positions[*parent], positions[j]) < kWithin) {
        ++within;
        break;
      }
    }
  }
  return limb.placed.size() > 1 && 2 * within >= limb.placed.size() - 1;
}

// Heights that the last bone before a tip lies deep in the body, in the mean.
double depthOfEnd(const TemplateLimb& limb, const std::vector<Vec3>& positions, const BodyVolume& body,
                  const AnatomicalFrame& frame) {
  constexpr int kSteps = 4;
  const Vec3 &from = positions[limb.placed[limb.placed.size() - 3]],
             &to = positions[limb.placed[limb.placed.size() - 2]];
  double depth = 0;
  for (int step = 1; step <= kSteps; ++step) {
    const Vec3 position = from + static_cast<double>(step) / kSteps * (to - from);
    depth -= body.distance->at(frame.fromBody(position)) / (kSteps * frame.height);
  }
  return depth;
}

// Whether a limb ends far deeper in the body than that of the other side, and so lies in the trunk.
bool isSunken(const TemplateSkeleton& skeleton, const TemplateLimb& limb, const std::vector<TemplateLimb>& limbs,
              const std::vector<Vec3>& positions, const BodyVolume& body, const AnatomicalFrame& frame) {
  if (limb.placed.size() < 3 || skeleton.joints[limb.placed.back()].role != TemplateRole::kTip) return false;
  const std::optional<Index> mirror = skeleton.joints[limb.placed.back()].mirror;
  if (!mirror) return false;
  const auto other = std::find_if(limbs.begin(), limbs.end(), [&](const TemplateLimb& one) {
    return one.placed.size() == limb.placed.size() && one.placed.back() == *mirror;
  });
  if (other == limbs.end()) return false;
  const double thick = std::max(kThinnest, depthOfEnd(*other, positions, body, frame));
  return depthOfEnd(limb, positions, body, frame) > kSunken * thick + kSunkenDepth;
}

}  // namespace

std::vector<TemplateLimb> limbChains(const TemplateSkeleton& skeleton) {
  // Fingers, which nobody searches for, do not end an arm.
  std::vector<bool> leadsOn(skeleton.jointCount(), false);
  std::vector<Index> children(skeleton.jointCount(), 0), limbOf(skeleton.jointCount(), 0);
  for (Index j = skeleton.jointCount(); j-- > 0;) {
    const TemplateJoint& joint = skeleton.joints[j];
    leadsOn[j] = leadsOn[j] || joint.role != TemplateRole::kBetween;
    if (!joint.parent || !leadsOn[j]) continue;
    leadsOn[*joint.parent] = true;
    ++children[*joint.parent];
  }
  std::vector<TemplateLimb> limbs;
  for (Index j = 0; j < skeleton.jointCount(); ++j) {
    const TemplateJoint& joint = skeleton.joints[j];
    if (joint.parent && leadsOn[j] && children[*joint.parent] == 1) {
      limbOf[j] = limbOf[*joint.parent];
    } else {
      limbOf[j] = static_cast<Index>(limbs.size());
      limbs.emplace_back();
    }
    TemplateLimb& limb = limbs[limbOf[j]];
    if (joint.role != TemplateRole::kTip) limb.joints.push_back(j);
    if (joint.role != TemplateRole::kBetween) limb.placed.push_back(j);
  }
  std::erase_if(limbs, [](const TemplateLimb& limb) { return limb.joints.empty() || limb.placed.empty(); });
  return limbs;
}

double distanceToBone(const Vec3& position, const Vec3& a, const Vec3& b) {
  const double along = std::clamp((position - a).dot(b - a) / std::max((b - a).squaredNorm(), 1e-12), 0.0, 1.0);
  return (position - a - along * (b - a)).norm();
}

std::vector<TemplateLimb> limbsIn(const TemplateSkeleton& skeleton, const TemplateEmbedding& embedding,
                                  const BodyVolume& body, const AnatomicalFrame& frame) {
  std::vector<TemplateLimb> limbs = limbChains(skeleton);
  for (TemplateLimb& limb : limbs) {
    double cost = 0;
    for (const Index j : limb.placed) cost += embedding.costs[j] / static_cast<double>(limb.placed.size());
    limb.hasMatch = cost < kNoMatch && !hasCommonEnd(skeleton, limb, embedding.positions, body, frame) &&
                    !isSunken(skeleton, limb, limbs, embedding.positions, body, frame) &&
                    !(skeleton.bent() && liesInAnother(skeleton, limb, embedding.positions));
  }
  return limbs;
}

void findHeadless(const TemplateSkeleton& skeleton, const std::vector<Vec3>& positions,
                  std::vector<TemplateLimb>& limbs) {
  if (!isHumanoid(skeleton) || skeleton.bent()) return;
  const auto at = [&](const char* joint) -> const Vec3& { return positions[skeleton.find(joint).value()]; };
  const Vec3 shoulders = 0.5 * (at("leftUpperArm") + at("rightUpperArm")), trunk = shoulders - at("hips");
  if ((at("headTip") - shoulders).dot(trunk) > kMinHead * trunk.squaredNorm()) return;
  const Index head = skeleton.find("head").value();
  for (TemplateLimb& limb : limbs) {
    if (std::find(limb.joints.begin(), limb.joints.end(), head) != limb.joints.end()) limb.hasMatch = false;
  }
}

std::string unmatchedLimbs(const TemplateSkeleton& skeleton, const std::vector<TemplateLimb>& limbs) {
  std::string names;
  for (const TemplateLimb& limb : limbs) {
    if (limb.hasMatch) continue;
    const std::string &first = skeleton.joints[limb.joints.front()].name,
                      &last = skeleton.joints[limb.joints.back()].name;
    names += names.empty() ? "" : ", ";
    names += first;
    if (first != last) names += " to " + last;
  }
  return names;
}

}  // namespace limber
