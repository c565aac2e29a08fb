#include "limber/actions/export/joint_frames.h"

#include <algorithm>
#include <string>

#include "limber/core/transform.h"
#include "limber/document/gltf/accessor.h"
#include "limber/document/rig/bind_pose.h"
#include "limber/document/scene/node_edit.h"
#include "limber/document/scene/scene_graph.h"

namespace limber {

namespace {

constexpr double kEven = 1e-6;  // relative: scales that differ less are one

bool isUneven(const Vec3& scale) {
  return !(scale.minCoeff() > 0) || scale.maxCoeff() - scale.minCoeff() > kEven * scale.maxCoeff();
}

Affine afterOf(const FrameChange& change) {
  return Affine(change.turn * Eigen::Scaling(change.scale));
}

// What a change does to translations, rotations and scales, each by itself.
class PartChange {
 public:
  explicit PartChange(const FrameChange& change) : before_(change.before), turn_(change.turn) {
    const Transform parts = decompose(change.before);
    rotation_ = parts.rotation;
    scale_ = change.scale * parts.scale.x();
    const Mat3 axes = turn_.toRotationMatrix().transpose().cwiseAbs();
    if (turnsByQuarters(axes)) axes_ = axes.array().round().matrix();
  }

  Vec3 translation(const Vec3& value, bool isTangent) const {
    return isTangent ? Vec3(before_.linear() * value) : before_ * value;
  }
  Vec4 rotation(const Vec4& value) const { return (rotation_ * Quat(value) * turn_).coeffs(); }
  Vec3 scale(const Vec3& value) const { return scale_ * (axes_ * value); }

 private:
  static bool turnsByQuarters(const Mat3& axes) {
    return (axes - axes.array().round().matrix()).cwiseAbs().maxCoeff() < kEven;
  }

  Affine before_;
  Quat turn_, rotation_;
  double scale_ = 1;
  Mat3 axes_ = Mat3::Identity();  // where a scale is even it does not matter
};

void changeNode(gltf::Node& node, const FrameChange& change) {
  if (node.matrix) return setNodeTransform(node, change.before * nodeTransform(node) * afterOf(change), true);
  const PartChange parts(change);
  const Vec3 translation = parts.translation(node.translation.value_or(Vec3::Zero()), false);
  const Vec4 rotation = parts.rotation(node.rotation.value_or(Quat::Identity().coeffs())).normalized();
  const Vec3 scale = parts.scale(node.scale.value_or(Vec3::Ones()));
  node.clearTransform();
  if (translation != Vec3::Zero()) node.translation = translation.unaryExpr(&shortDouble);
  if (rotation != Quat::Identity().coeffs()) node.rotation = rotation.unaryExpr(&shortDouble);
  if (scale != Vec3::Ones()) node.scale = scale.unaryExpr(&shortDouble);
}

// The keys of one channel, changed; a new accessor.
Index changedKeys(Asset& asset, const gltf::AnimationSampler& sampler, const std::string& path,
                  const PartChange& change) {
  std::vector<float> values = readFloats(asset, sampler.output);
  const std::size_t size = path == "rotation" ? 4 : 3;
  const bool isCubic = sampler.interpolation == Interpolation::kCubic;
  for (std::size_t v = 0; (v + 1) * size <= values.size(); ++v) {
    float* value = &values[v * size];
    const bool isTangent = isCubic && v % 3 != 1;
    if (path == "rotation") {
      const Vec4 turned = change.rotation(Vec4(value[0], value[1], value[2], value[3]));
      for (int i = 0; i < 4; ++i) value[i] = static_cast<float>(turned[i]);
    } else {
      const Vec3 before(value[0], value[1], value[2]);
      const Vec3 after = path == "scale" ? change.scale(before) : change.translation(before, isTangent);
      for (int i = 0; i < 3; ++i) value[i] = static_cast<float>(after[i]);
    }
  }
  return addFloatAccessor(asset, values, static_cast<Index>(size));
}

bool isTransform(std::string_view path) {
  return path == "translation" || path == "rotation" || path == "scale";
}

// A sampler that several channels use is copied for all but the last.
void changeAnimation(Asset& asset, Index number, std::span<const FrameChange> changes) {
  gltf::Animation& animation = asset.document.animations[number];
  std::vector<Index> uses(animation.samplers.size(), 0);
  for (const gltf::AnimationChannel& channel : animation.channels) ++uses[channel.sampler];
  for (gltf::AnimationChannel& channel : animation.channels) {
    const ChannelTarget target = channelTarget(channel);
    if (!target.node || !isTransform(target.path) || *target.node >= changes.size()) continue;
    const FrameChange& change = changes[*target.node];
    if (change.isNone()) continue;
    gltf::AnimationSampler sampler = animation.samplers[channel.sampler];
    sampler.output = changedKeys(asset, sampler, target.path, PartChange(change));
    if (--uses[channel.sampler] == 0) {
      animation.samplers[channel.sampler] = std::move(sampler);
    } else {
      channel.sampler = addElement(animation.samplers, std::move(sampler));
      uses.push_back(1);
    }
  }
}

void changeSkin(Asset& asset, Index number, std::span<const FrameChange> changes) {
  const SkinBinding binding = readSkinBinding(asset, number);
  const auto isChanged = [&](Index node) { return !changes[node].isNone(); };
  if (std::none_of(binding.joints.begin(), binding.joints.end(), isChanged)) return;
  std::vector<float> values;
  for (std::size_t j = 0; j < binding.joints.size(); ++j) {
    const Affine toJoint = afterOf(changes[binding.joints[j]]).inverse(Eigen::Affine) * binding.inverseBinds[j];
    for (int i = 0; i < 16; ++i) values.push_back(static_cast<float>(toJoint.matrix()(i % 4, i / 4)));
  }
  asset.document.skins[number].inverseBindMatrices = addFloatAccessor(asset, values, 16);
}

}  // namespace

bool FrameChange::isNone() const {
  return before.matrix().isIdentity(0) && turn.coeffs() == Quat::Identity().coeffs() && scale == 1;
}

void changeFrames(Asset& asset, std::span<const FrameChange> changes) {
  gltf::Document& document = asset.document;
  for (Index s = 0; s < document.skins.size(); ++s) changeSkin(asset, s, changes);
  for (Index a = 0; a < document.animations.size(); ++a) changeAnimation(asset, a, changes);
  for (Index n = 0; n < changes.size(); ++n) {
    if (!changes[n].isNone()) changeNode(document.nodes[n], changes[n]);
  }
}

std::vector<bool> unevenlyScaled(const Asset& asset) {
  const gltf::Document& document = asset.document;
  std::vector<bool> uneven(document.nodes.size(), false);
  for (Index n = 0; n < document.nodeCount(); ++n) uneven[n] = isUneven(document.nodes[n].scale.value_or(Vec3::Ones()));
  for (const gltf::Animation& animation : document.animations) {
    for (const gltf::AnimationChannel& channel : animation.channels) {
      const ChannelTarget target = channelTarget(channel);
      if (!target.node || *target.node >= uneven.size() || target.path != "scale" || uneven[*target.node]) continue;
      const std::vector<float> values = readFloats(asset, animation.samplers[channel.sampler].output);
      const bool isCubic = animation.samplers[channel.sampler].interpolation == Interpolation::kCubic;
      for (std::size_t v = 0; 3 * (v + 1) <= values.size(); ++v) {
        const Vec3 value(values[3 * v], values[3 * v + 1], values[3 * v + 2]);
        const bool isTangent = isCubic && v % 3 != 1;
        if (isTangent ? (value.array() != value.x()).any() : isUneven(value)) uneven[*target.node] = true;
      }
    }
  }
  return uneven;
}

}  // namespace limber
