#include "limber/skeleton/clip/mirror_clip.h"

namespace limber {

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
  // A rotation seen from the rest pose, in the skeleton's axes: its axis is mirrored and its sense reversed. All steps
  // are linear in the quaternion, so tangents are mirrored likewise.
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
