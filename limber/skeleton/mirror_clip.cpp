#include "limber/skeleton/mirror_clip.h"

#include <array>
#include <cmath>
#include <map>
#include <string>

#include "limber/skeleton/humanoid_names.h"

namespace limber {

namespace {

constexpr double kNear = 0.03;     // of the skeleton's size
constexpr double kOnAxis = 0.985;  // cosine of 10 degrees: the plane is meant to be an axis's

bool isSeparator(char c) {
  return c == '_' || c == '.' || c == '-' || c == ' ' || c == ':';
}

bool isLower(char c) {
  return c >= 'a' && c <= 'z';
}

// Is the letter at `at` a word of its own, or the side in "lFoot" and "FootL"?
bool standsAlone(const std::string& name, std::size_t at) {
  const bool begins = at == 0 || isSeparator(name[at - 1]), ends = at + 1 == name.size() || isSeparator(name[at + 1]);
  if (begins && ends) return name.size() > 1;
  if (begins && isLower(name[at]) && !ends) return name[at + 1] >= 'A' && name[at + 1] <= 'Z';
  return ends && !isLower(name[at]) && at > 0 && isLower(name[at - 1]);
}

// The joint whose name says the other side.
std::optional<Index> otherSide(const std::map<std::string, Index>& byName, const std::string& name) {
  constexpr std::array<std::array<const char*, 2>, 3> kSideWords = {
      {{"left", "right"}, {"Left", "Right"}, {"LEFT", "RIGHT"}}};
  const auto lookUp = [&](std::string other) -> std::optional<Index> {
    const auto found = byName.find(other);
    return found == byName.end() ? std::nullopt : std::optional(found->second);
  };
  for (const auto& pair : kSideWords) {
    for (int side = 0; side < 2; ++side) {
      const std::string from = pair[static_cast<std::size_t>(side)], to = pair[static_cast<std::size_t>(1 - side)];
      const std::size_t at = name.find(from);
      if (at == std::string::npos) continue;
      if (const auto joint = lookUp(std::string(name).replace(at, from.size(), to))) return joint;
    }
  }
  constexpr std::string_view kLetters = "lrLR", kOthers = "rlRL";
  for (std::size_t at = 0; at < name.size(); ++at) {
    const std::size_t letter = kLetters.find(name[at]);
    if (letter == std::string_view::npos || !standsAlone(name, at)) continue;
    std::string other = name;
    other[at] = kOthers[letter];
    if (const auto joint = lookUp(other)) return joint;
  }
  return std::nullopt;
}

std::vector<std::optional<Index>> partnersByName(const Skeleton& skeleton) {
  std::vector<std::optional<Index>> partner(skeleton.jointCount());
  std::map<std::string, Index> byName;
  for (Index j = 0; j < skeleton.jointCount(); ++j) byName.emplace(skeleton.joints[j].name, j);
  for (Index j = 0; j < skeleton.jointCount(); ++j) partner[j] = otherSide(byName, skeleton.joints[j].name);
  std::map<std::string_view, Index> byBone;
  const std::vector<HumanoidJoint> bones = humanoidJointsByName(skeleton);
  for (const HumanoidJoint& bone : bones) byBone.emplace(bone.bone, bone.joint);
  for (const HumanoidJoint& bone : bones) {
    const auto other = byBone.find(mirroredBone(bone.bone));
    if (other != byBone.end() && other->second != bone.joint && !partner[bone.joint]) {
      partner[bone.joint] = other->second;
    }
  }
  for (Index j = 0; j < partner.size(); ++j) {  // both must mean each other
    if (partner[j] && partner[*partner[j]] != j) partner[j].reset();
  }
  return partner;
}

Vec3 normalBetween(const std::vector<Affine>& rest, const std::vector<std::optional<Index>>& partner) {
  Vec3 sum = Vec3::Zero();
  for (Index j = 0; j < partner.size(); ++j) {
    if (!partner[j] || *partner[j] < j) continue;
    const Vec3 across = rest[j].translation() - rest[*partner[j]].translation();
    sum += across.dot(sum) < 0 ? Vec3(-across) : across;
  }
  if (sum.norm() == 0) return Vec3::UnitX();
  sum.normalize();
  Eigen::Index axis = 0;
  return sum.cwiseAbs().maxCoeff(&axis) > kOnAxis ? Vec3(Vec3::Unit(axis)) : sum;
}

// Of the joints below `parent`, the one nearest to a place, if it is near enough.
std::optional<Index> childNear(const Skeleton& skeleton, const std::vector<Affine>& rest, std::optional<Index> parent,
                               const Vec3& place, double reach) {
  std::optional<Index> best;
  for (Index j = parent ? *parent + 1 : 0; j < skeleton.jointCount(); ++j) {
    if (skeleton.joints[j].parent != parent) continue;
    const double distance = (rest[j].translation() - place).norm();
    if (distance > reach) continue;
    reach = distance;
    best = j;
  }
  return best;
}

}  // namespace

SkeletonMirror findMirror(const Skeleton& skeleton) {
  SkeletonMirror mirror;
  if (skeleton.joints.empty()) return mirror;
  const std::vector<Affine> rest = restGlobals(skeleton);
  const std::vector<std::optional<Index>> named = partnersByName(skeleton);
  mirror.normal = normalBetween(rest, named);
  Box box;
  for (const Affine& global : rest) box.add(global.translation());
  const Vec3 origin = rest.front().translation();
  for (Index j = 0; j < skeleton.jointCount(); ++j) {
    const std::optional<Index> parent = skeleton.joints[j].parent;
    const std::optional<Index> opposite = parent ? std::optional(mirror.partner[*parent]) : std::nullopt;
    const Vec3 place = rest[j].translation();
    const Vec3 image = place - 2 * mirror.normal.dot(place - origin) * mirror.normal;
    std::optional<Index> partner = named[j];
    if (!partner) partner = childNear(skeleton, rest, opposite, image, kNear * box.diagonal());
    const bool fits = partner && skeleton.joints[*partner].parent == opposite;
    mirror.partner.push_back(fits ? *partner : j);
  }
  for (Index j = 0; j < mirror.partner.size(); ++j) {
    if (mirror.partner[mirror.partner[j]] != j) mirror.partner[j] = j;
  }
  return mirror;
}

Clip mirrorClip(const Clip& clip, const Skeleton& skeleton, const SkeletonMirror& mirror) {
  std::vector<Quat> rest;  // rest rotations in the skeleton's space
  for (const Joint& joint : skeleton.joints) {
    rest.push_back(joint.parent ? (rest[*joint.parent] * joint.rest.rotation).normalized() : joint.rest.rotation);
  }
  const auto above = [&](Index j) {
    const std::optional<Index> parent = skeleton.joints[j].parent;
    return parent ? rest[*parent] : Quat::Identity();
  };
  const Vec3& n = mirror.normal;
  const auto reflect = [&](const Vec3& v) { return Vec3(v - 2 * n.dot(v) * n); };
  Clip result;
  result.name = clip.name;
  // A rotation seen from the rest pose, in the skeleton's axes: its axis is mirrored and its sense turned round. All
  // steps are linear in the quaternion, so tangents go the same way.
  for (const auto& track : clip.rotations) {
    const Index to = mirror.partner[track.joint];
    const Quat left = above(track.joint), right = rest[track.joint].inverse();
    const Quat leftTo = above(to).inverse(), rightTo = rest[to];
    auto turned = track;
    turned.joint = to;
    for (Eigen::Quaternionf& value : turned.values) {
      Quat q = left * value.cast<double>() * right;
      q.vec() = -reflect(q.vec());
      value = (leftTo * q * rightTo).cast<float>();
    }
    result.rotations.push_back(std::move(turned));
  }
  for (const auto& track : clip.translations) {
    const Index to = mirror.partner[track.joint];
    const bool cubic = track.interpolation == Interpolation::kCubic;
    auto moved = track;
    moved.joint = to;
    for (std::size_t v = 0; v < moved.values.size(); ++v) {
      const bool tangent = cubic && v % 3 != 1;
      Vec3 offset = moved.values[v].cast<double>();
      if (!tangent) offset -= skeleton.joints[track.joint].rest.translation;
      offset = above(to).inverse() * reflect(above(track.joint) * offset);
      if (!tangent) offset += skeleton.joints[to].rest.translation;
      moved.values[v] = offset.cast<float>();
    }
    result.translations.push_back(std::move(moved));
  }
  for (const auto& track : clip.scales) {
    result.scales.push_back(track);
    result.scales.back().joint = mirror.partner[track.joint];
  }
  return result;
}

}  // namespace limber
