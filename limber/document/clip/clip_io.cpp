#include "limber/document/clip/clip_io.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <map>
#include <numeric>
#include <set>
#include <span>
#include <utility>

#include <fmt/format.h>

#include "limber/core/file/read_bounds.h"
#include "limber/core/sort_unique.h"
#include "limber/document/gltf/accessor.h"
#include "limber/document/rig/pose_io.h"
#include "limber/document/scene/mirrored_scale.h"
#include "limber/document/scene/node_edit.h"
#include "limber/document/scene/scene_graph.h"
#include "limber/document/unique_names.h"
#include "limber/skeleton/clip/tracks.h"

namespace limber {

namespace {

constexpr const char *kTranslation = "translation", *kRotation = "rotation", *kScale = "scale";
// Of a length or in radians: the same but for rounding. Inverse bind matrices are rounded where the joint is, so that
// the length of a short bone is off by some 1e-6 of it.
constexpr double kSameTransform = 1e-5;
constexpr float kStanding = 1e-6f;  // likewise, of a node's own value

template <typename Value>
void addKey(Track<Value>& track, float time, const Value& value) {
  track.times.push_back(time);
  track.values.push_back(value);
}

template <typename Value>
Track<Value> constantTrack(const Value& value) {
  Track<Value> track;
  addKey(track, 0.0f, value);
  return track;
}

// The tracks of one node.
struct NodeTracks {
  std::optional<Track<Vec3f>> translation, scale;
  std::optional<Track<Eigen::Quaternionf>> rotation;

  bool any() const { return translation || rotation || scale; }

  void addTimes(std::vector<float>& times) const {
    const auto add = [&](const auto& track) {
      if (track) times.insert(times.end(), track->times.begin(), track->times.end());
    };
    add(translation);
    add(rotation);
    add(scale);
  }

  // From a node's own numbers to those that decompose() finds, and back: a half turn undoes itself.
  void turnMirror(const gltf::Node& node) {
    const Vec3 half = halfTurnOfMirror(node.scale.value_or(Vec3::Ones()));
    if (half == Vec3::Ones()) return;
    const Eigen::Quaternionf turn(Eigen::Matrix3f(half.cast<float>().asDiagonal()));
    if (rotation) {
      for (Eigen::Quaternionf& value : rotation->values) value = value * turn;
    }
    if (scale) {
      for (Vec3f& value : scale->values) value = value.cwiseProduct(half.cast<float>());
    }
  }

  Transform at(double seconds, const Transform& otherwise) const {
    Transform result = otherwise;
    if (translation) result.translation = sampleTrack(*translation, seconds);
    if (rotation) result.rotation = sampleTrack(*rotation, seconds);
    if (scale) result.scale = sampleTrack(*scale, seconds);
    return result;
  }
};

// The node's own numbers; those that decompose() finds of a matrix.
Transform ownTransform(const gltf::Node& node) {
  return turnedMirror(decompose(nodeTransform(node)), halfTurnOfMirror(node.scale.value_or(Vec3::Ones())));
}

bool isNear(std::span<const float> values, const Eigen::Vector4d& own) {
  double squares = 0;
  for (std::size_t i = 0; i < values.size(); ++i) {
    const double off = double{values[i]} - own[static_cast<Eigen::Index>(i)];
    squares += off * off;
  }
  return std::sqrt(squares) <= double{kStanding} * std::max(own.norm(), 1.0);  // false for NaN
}

// What the nodes above a root joint do to it, if they stand still.
Affine frameAbove(const SceneGraph& graph, Index node) {
  return graph.parent[node] ? graph.world[*graph.parent[node]] : Affine::Identity();
}

// Does the frame only move, turn and scale evenly, so that it can be multiplied into tracks one by one?
bool isSimilarity(const Affine& frame) {
  bool sheared = false;
  const Vec3 scale = decompose(frame, &sheared).scale;
  constexpr double kTolerance = 1e-6;
  return !sheared && scale.x() > 0 &&
         (scale - Vec3::Constant(scale.x())).cwiseAbs().maxCoeff() < kTolerance * scale.x();
}

// `frame` times what the tracks say. It is a similarity.
void premultiply(const Affine& frame, NodeTracks& tracks) {
  const Transform by = decompose(frame);
  const auto isTangent = [](const auto& track, std::size_t v) {
    return track.interpolation == Interpolation::kCubic && v % 3 != 1;
  };
  if (tracks.translation) {
    for (std::size_t v = 0; v < tracks.translation->values.size(); ++v) {
      Vec3f& value = tracks.translation->values[v];
      const Vec3 turned = frame.linear() * value.cast<double>();
      value = (isTangent(*tracks.translation, v) ? turned : Vec3(turned + frame.translation())).cast<float>();
    }
  }
  if (tracks.rotation) {
    for (Eigen::Quaternionf& value : tracks.rotation->values) {
      value = (by.rotation * value.cast<double>()).cast<float>();
    }
  }
  if (tracks.scale) {
    for (Vec3f& value : tracks.scale->values) value = (by.scale.x() * value.cast<double>()).cast<float>();
  }
}

std::string animationLocation(const gltf::Document& document, Index animation) {
  const std::string& name = document.animations[animation].name;
  return name.empty() ? fmt::format("animations[{}]", animation) : fmt::format("animation '{}'", name);
}

}  // namespace

void checkKeySharing(const Asset& asset, std::span<const Index> animations) {
  std::uint64_t stored = 0, read = 0;
  for (const Asset::Buffer& buffer : asset.buffers) stored += buffer.bytes.size() / sizeof(float);
  const std::uint64_t most = read_bounds::kClipNumbers.larger(stored);
  for (const Index a : animations) {
    const gltf::Animation& animation = asset.document.animations[a];
    for (const gltf::AnimationChannel& channel : animation.channels) {
      const std::string& path = channel.target.path;
      if (!channel.target.node || (path != kTranslation && path != kRotation && path != kScale)) continue;
      const gltf::AnimationSampler& sampler = animation.samplers[channel.sampler];
      for (const Index accessor : {sampler.input, sampler.output}) {
        const AccessorInfo info = accessorInfo(asset, accessor);
        read += std::uint64_t{info.count} * info.components;
      }
      if (read <= most) continue;
      throw Error(ErrorCode::kLimit, "shares its keys among so many channels that they take too much memory",
                  animationLocation(asset.document, a), "export it with fewer clips or moving nodes");
    }
  }
}

bool repeatsItsNode(const Asset& asset, const gltf::Animation& animation, const gltf::AnimationChannel& channel) {
  if (!channel.target.node) return false;
  const std::string& path = channel.target.path;
  const Transform transform = ownTransform(asset.document.nodes[*channel.target.node]);
  Eigen::Vector4d own = Eigen::Vector4d::Zero();
  if (path == kTranslation) {
    own.head<3>() = transform.translation;
  } else if (path == kRotation) {
    own = transform.rotation.coeffs();
  } else if (path == kScale) {
    own.head<3>() = transform.scale;
  } else {
    return false;
  }
  const gltf::AnimationSampler& sampler = animation.samplers[channel.sampler];
  const std::size_t components = path == kRotation ? 4 : 3;
  const std::vector<float> numbers = readFloats(asset, sampler.output);
  for (std::size_t v = 0; v < numbers.size() / components; ++v) {
    const std::span<const float> value = std::span(numbers).subspan(v * components, components);
    const bool isTangent = sampler.interpolation == Interpolation::kCubic && v % 3 != 1;
    const bool isStill = isTangent ? isNear(value, Eigen::Vector4d::Zero())
                                   : isNear(value, own) || (path == kRotation && isNear(value, -own));
    if (!isStill) return false;
  }
  return true;
}

namespace {

// Reads the animations of one document.
class ClipReader {
 public:
  ClipReader(const Asset& asset, const AssetSkeleton& skeleton, Warnings& warnings)
      : asset_(asset), skeleton_(skeleton), warnings_(warnings), graph_(readSceneGraph(asset.document)) {
    isJoint_.resize(graph_.nodeCount(), false);
    nodePose_ = readNodePose(asset, skeleton);
    for (const Index node : skeleton.jointNode) isJoint_[node] = true;
    for (const Affine& global : restGlobals(skeleton.skeleton)) box_.add(global.translation());
  }

  Clip read(Index number) {
    const gltf::Animation& animation = asset_.document.animations[number];
    number_ = number;
    Clip clip;
    clip.name = animation.name;
    nodes_.clear();
    moving_.clear();
    for (const gltf::AnimationChannel& channel : animation.channels) {
      if (!channel.target.node) continue;
      const Index node = *channel.target.node;
      if (!isJoint_[node] && !repeatsItsNode(asset_, animation, channel)) moving_.insert(node);
      readChannel(animation.samplers[channel.sampler], channel.target.path, *channel.target.node);
    }
    for (auto& [node, tracks] : nodes_) tracks.turnMirror(asset_.document.nodes[node]);
    std::vector<std::vector<float>> times(skeleton_.skeleton.jointCount());  // of those that are sampled
    for (Index j = 0; j < times.size(); ++j) {
      if (!isSampled(j)) continue;
      const std::vector<Index> chain = chainOf(skeleton_.jointNode[j]);
      times[j] = sampleTimes(chain);
      countSamples(times[j].size(), chain.size());
    }
    for (Index j = 0; j < times.size(); ++j) addJoint(j, std::move(times[j]), clip);
    return clip;
  }

 private:
  void readChannel(const gltf::AnimationSampler& sampler, const std::string& path, Index node) {
    NodeTracks& tracks = nodes_[node];
    if (path == kTranslation) tracks.translation = readTrack<Vec3f>(sampler);
    if (path == kRotation) tracks.rotation = readTrack<Eigen::Quaternionf>(sampler);
    if (path == kScale) tracks.scale = readTrack<Vec3f>(sampler);
    if (!tracks.any()) nodes_.erase(node);
  }

  template <typename Value>
  std::optional<Track<Value>> readTrack(const gltf::AnimationSampler& sampler) {
    constexpr bool kIsRotation = std::is_same_v<Value, Eigen::Quaternionf>;
    constexpr std::size_t kComponents = kIsRotation ? 4 : 3;
    Track<Value> track;
    track.interpolation = sampler.interpolation;
    const std::size_t valuesPerKey = track.interpolation == Interpolation::kCubic ? 3 : 1;
    const std::vector<float> times = readFloats(asset_, sampler.input);
    const std::vector<float> numbers = readFloats(asset_, sampler.output);
    const std::size_t keys = std::min(times.size(), numbers.size() / (kComponents * valuesPerKey));
    for (std::size_t k = 0; k < keys; ++k) {
      std::array<Value, 3> values;
      bool valid = std::isfinite(times[k]) && (track.times.empty() || times[k] > track.times.back());
      for (std::size_t v = 0; v < valuesPerKey; ++v) {
        values[v] = Value(numbers.data() + kComponents * (k * valuesPerKey + v));
        const bool isTangent = valuesPerKey == 3 && v != 1;
        if constexpr (kIsRotation) {
          const double length = values[v].coeffs().template cast<double>().norm();
          if (!isTangent && length > 0) values[v].coeffs() /= static_cast<float>(length);
          valid = valid && values[v].coeffs().allFinite() && (isTangent || length > 0);
        } else {
          valid = valid && values[v].allFinite();
        }
      }
      if (!valid) {
        warnings_.add("invalid-keys", "animation keys that are not finite or not in order are left out");
        continue;
      }
      track.times.push_back(times[k]);
      track.values.insert(track.values.end(), values.begin(),
                          values.begin() + static_cast<std::ptrdiff_t>(valuesPerKey));
    }
    return track.times.empty() ? std::nullopt : std::optional(std::move(track));
  }

  bool isSampled(Index j) const {
    const Index node = skeleton_.jointNode[j];
    if (skeleton_.skeleton.joints[j].parent) return false;
    return movesAbove(node) || (nodes_.count(node) > 0 && !isSimilarity(frameAbove(graph_, node)));
  }

  // `times`: when it is sampled, if it is.
  void addJoint(Index j, std::vector<float> times, Clip& clip) {
    const Index node = skeleton_.jointNode[j];
    NodeTracks tracks;
    if (const auto known = nodes_.find(node); known != nodes_.end()) tracks = known->second;
    if (!times.empty()) {
      tracks = sampled(node, std::move(times));
    } else if (!skeleton_.skeleton.joints[j].parent && tracks.any()) {
      premultiply(frameAbove(graph_, node), tracks);
    }
    keepStanding(j, tracks);
    if (tracks.translation) store(clip.translations, j, std::move(*tracks.translation));
    if (tracks.rotation) store(clip.rotations, j, std::move(*tracks.rotation));
    if (tracks.scale) store(clip.scales, j, std::move(*tracks.scale));
  }

  template <typename Value>
  static void store(std::vector<Track<Value>>& tracks, Index joint, Track<Value> track) {
    track.joint = joint;
    tracks.push_back(std::move(track));
  }

  bool movesAbove(Index node) const {
    for (std::optional<Index> n = graph_.parent[node]; n; n = graph_.parent[*n]) {
      if (nodes_.count(*n) > 0) return true;
    }
    return false;
  }

  // The node and those above it, from the top down.
  std::vector<Index> chainOf(Index node) const {
    std::vector<Index> chain;
    for (std::optional<Index> n = node; n; n = graph_.parent[*n]) chain.push_back(*n);
    std::reverse(chain.begin(), chain.end());
    return chain;
  }

  // Every key of these nodes, and between.
  std::vector<float> sampleTimes(const std::vector<Index>& chain) {
    std::vector<float> times;
    for (const Index n : chain) {
      if (const auto known = nodes_.find(n); known != nodes_.end()) known->second.addTimes(times);
    }
    countTransforms(times.size());  // sorting keys takes time, too
    addTimesBetween(times);
    return times;
  }

  // The node's movement in the world.
  NodeTracks sampled(Index node, std::vector<float> times) {
    struct Link {
      const NodeTracks* tracks = nullptr;  // null: it is not animated
      Transform rest;
    };
    const std::vector<Index> chain = chainOf(node);
    std::vector<Link> links(chain.size());
    for (std::size_t i = 0; i < chain.size(); ++i) {
      const auto known = nodes_.find(chain[i]);
      if (known != nodes_.end()) links[i] = {&known->second, decompose(graph_.local[chain[i]])};
    }
    const bool moves = std::any_of(chain.begin(), chain.end(), [&](Index n) { return moving_.count(n) > 0; });
    if (moves || !isSimilarity(frameAbove(graph_, node))) {
      warnings_.add("moving-parents",
                    "root joints have nodes above them that move or are stretched: sampled 60 times a second",
                    skeleton_.skeleton.joints[0].name);
    }
    NodeTracks result;
    result.translation.emplace();
    result.rotation.emplace();
    result.scale.emplace();
    for (const float time : times) {
      Affine world = Affine::Identity();
      for (std::size_t i = 0; i < chain.size(); ++i) {
        const Link& link = links[i];
        world = world * (link.tracks ? link.tracks->at(time, link.rest).toAffine() : graph_.local[chain[i]]);
      }
      const Transform local = decompose(world);
      Eigen::Quaternionf rotation(local.rotation.cast<float>());
      auto& rotations = result.rotation->values;
      if (!rotations.empty() && rotations.back().coeffs().dot(rotation.coeffs()) < 0) rotation.coeffs() *= -1;
      result.translation->values.emplace_back(local.translation.cast<float>());
      rotations.push_back(rotation);
      result.scale->values.emplace_back(local.scale.cast<float>());
    }
    result.translation->times = result.rotation->times = result.scale->times = std::move(times);
    return result;
  }

  static void addTimesBetween(std::vector<float>& times) {
    constexpr double kRate = 60, kMaxSamples = 1e6;
    const auto [first, last] = std::minmax_element(times.begin(), times.end());
    const double begin = *first, samples = (double{*last} - begin) * kRate;
    for (double i = 1; i < samples && samples < kMaxSamples; ++i)
      times.push_back(static_cast<float>(begin + i / kRate));
    sortUnique(times);
  }

  // Of all clips: a few kilobytes of nodes and keys must not ask for gigabytes, nor for minutes.
  void countSamples(std::size_t added, std::size_t nodes) {
    samples_ += added;
    if (samples_ > read_bounds::kSamples.of(0)) failTooLong();
    countTransforms(added * nodes);
  }

  void countTransforms(std::size_t added) {
    transforms_ += added;
    if (transforms_ > read_bounds::kSampledNodes.of(0)) failTooLong();
  }

  [[noreturn]] void failTooLong() const {
    throw Error(ErrorCode::kLimit, "is too long, with those before it, for all that hangs on nodes that they move",
                animationLocation(asset_.document, number_), "shorten them, or let their nodes stand still");
  }

  // A part that no channel moves stays where the node has it, which may be off the rest pose.
  void keepStanding(Index j, NodeTracks& tracks) const {
    const Transform &nodeRest = nodePose_.locals[j], &rest = skeleton_.skeleton.joints[j].rest;
    constexpr double kTolerance = 1e-5;
    const double size = std::max(box_.diagonal(), rest.translation.norm());
    if (!tracks.translation && (nodeRest.translation - rest.translation).norm() > kTolerance * size) {
      tracks.translation = constantTrack(Vec3f(nodeRest.translation.cast<float>()));
    }
    if (!tracks.rotation && nodeRest.rotation.angularDistance(rest.rotation) > kTolerance) {
      tracks.rotation = constantTrack(Eigen::Quaternionf(nodeRest.rotation.cast<float>()));
    }
    if (!tracks.scale && (nodeRest.scale - rest.scale).norm() > kTolerance * rest.scale.norm()) {
      tracks.scale = constantTrack(Vec3f(nodeRest.scale.cast<float>()));
    }
  }

  const Asset& asset_;
  const AssetSkeleton& skeleton_;
  Warnings& warnings_;
  SceneGraph graph_;
  std::vector<bool> isJoint_;  // #nodes
  Pose nodePose_;
  Box box_;
  Index number_ = 0;                   // of the animation being read
  std::map<Index, NodeTracks> nodes_;  // of that
  std::set<Index> moving_;             // nodes above joints, likewise, that do not stand still
  std::size_t samples_ = 0;            // of all that were read
  std::size_t transforms_ = 0;         // of nodes, for these samples
};

// Accessors that share a buffer view, which is made when all are there.
class SharedView {
 public:
  explicit SharedView(Asset& asset) : asset_(asset) {}

  // Times where there is one component, rotations where there are four.
  Index add(std::span<const float> values, Index components) {
    gltf::Accessor accessor;
    accessor.count = values.size() / components;
    accessor.type = components == 1   ? gltf::ElementType::kScalar
                    : components == 3 ? gltf::ElementType::kVec3
                                      : gltf::ElementType::kVec4;
    accessor.byteOffset = bytes_.size();
    if (components == 1) {
      accessor.min = {shortDouble(values.front())};
      accessor.max = {shortDouble(values.back())};
    }
    if (components == 4 && std::all_of(values.begin(), values.end(), isFraction)) {
      accessor.componentType = gltf::ComponentType::kI16;
      accessor.normalized = true;
      for (const float value : values) append(static_cast<std::int16_t>(std::lround(value * kFractions)));
    } else {
      for (const float value : values) append(value);
    }
    accessors_.push_back(addElement(asset_.document.accessors, std::move(accessor)));
    return accessors_.back();
  }

  void finish() {
    const Index view = addBufferView(asset_, bytes_);
    for (const Index accessor : accessors_) asset_.document.accessors[accessor].bufferView = view;
    bytes_.clear();
    accessors_.clear();
  }

 private:
  static constexpr float kFractions = 32767, kNearlyWhole = 4e-3f;

  static bool isFraction(float value) {
    const float fractions = value * kFractions;
    return std::abs(fractions) <= kFractions && std::abs(fractions - std::round(fractions)) < kNearlyWhole;
  }

  template <typename Number>
  void append(Number number) {
    const std::size_t end = bytes_.size();
    bytes_.resize(end + sizeof(number));
    std::memcpy(bytes_.data() + end, &number, sizeof(number));
  }

  Asset& asset_;
  Bytes bytes_;
  std::vector<Index> accessors_;
};

// Writes animations into one document.
class ClipWriter {
 public:
  ClipWriter(Asset& asset, const AssetSkeleton& skeleton, const ClipWriteOptions& options)
      : asset_(asset), skeleton_(skeleton) {
    if (options.compact) shared_.emplace(asset);
    const SceneGraph graph = readSceneGraph(asset.document);
    nodePose_ = readNodePose(asset, skeleton);
    for (Index j = 0; j < skeleton.skeleton.jointCount(); ++j) {
      const Index node = skeleton.jointNode[j];
      nodeLocal_.push_back(ownTransform(asset.document.nodes[node]));
      const bool root = !skeleton.skeleton.joints[j].parent;
      frames_.push_back(root ? frameAbove(graph, node) : Affine::Identity());
    }
    for (const gltf::Animation& animation : asset.document.animations) names_.add(animation.name);
  }

  std::string write(const Clip& clip) {
    animation_ = {};
    inputs_.clear();
    hold_ = durationToHold(clip);
    std::vector<NodeTracks> joints(skeleton_.skeleton.jointCount());
    for (const auto& track : clip.translations) joints[track.joint].translation = track;
    for (const auto& track : clip.rotations) joints[track.joint].rotation = track;
    for (const auto& track : clip.scales) joints[track.joint].scale = track;
    for (Index j = 0; j < joints.size(); ++j) writeJoint(j, joints[j]);
    if (animation_.channels.empty() && !joints.empty()) {  // glTF wants one
      addSampler(0, kRotation, constantTrack(Eigen::Quaternionf(nodeLocal_[0].rotation.cast<float>())));
    }
    if (shared_) shared_->finish();
    const std::string name = names_.add(clip.name.empty() ? "clip" : clip.name);
    animation_.name = name;
    asset_.document.animations.push_back(std::move(animation_));
    return name;
  }

 private:
  void writeJoint(Index j, NodeTracks& tracks) {
    const Joint& joint = skeleton_.skeleton.joints[j];
    const Transform& nodeRest = nodePose_.locals[j];
    // All three parts of a root below a frame hang together; elsewhere only those that say something are written.
    const bool framed = !frames_[j].matrix().isIdentity(0);
    if (framed && !tracks.any() && same(joint.rest, nodeRest)) return;
    if (!tracks.translation && (framed || differs(joint.rest.translation, nodeRest.translation))) {
      tracks.translation = constantTrack(Vec3f(joint.rest.translation.cast<float>()));
    }
    if (!tracks.rotation && (framed || joint.rest.rotation.angularDistance(nodeRest.rotation) > kSameTransform)) {
      tracks.rotation = constantTrack(Eigen::Quaternionf(joint.rest.rotation.cast<float>()));
    }
    if (!tracks.scale && (framed || differs(joint.rest.scale, nodeRest.scale))) {
      tracks.scale = constantTrack(Vec3f(joint.rest.scale.cast<float>()));
    }
    if (framed) intoFrame(j, tracks);
    tracks.turnMirror(asset_.document.nodes[skeleton_.jointNode[j]]);
    const Transform& local = nodeLocal_[j];
    if (tracks.translation) writeTrack(j, kTranslation, *tracks.translation, Vec3f(local.translation.cast<float>()));
    if (tracks.rotation) {
      writeTrack(j, kRotation, *tracks.rotation, Eigen::Quaternionf(local.rotation.cast<float>()));
    }
    if (tracks.scale) writeTrack(j, kScale, *tracks.scale, Vec3f(local.scale.cast<float>()));
  }

  static bool differs(const Vec3& a, const Vec3& b) {
    return (a - b).norm() > kSameTransform * std::max(a.norm(), b.norm());
  }

  static bool same(const Transform& a, const Transform& b) {
    return !differs(a.translation, b.translation) && a.rotation.angularDistance(b.rotation) <= kSameTransform &&
           !differs(a.scale, b.scale);
  }

  // From the world to the frame of the node above.
  void intoFrame(Index j, NodeTracks& tracks) const {
    const Affine inverse = frames_[j].inverse(Eigen::Affine);
    if (!inverse.matrix().allFinite()) {
      throw Error(ErrorCode::kBadData, "stands below a node with a scale of 0, so it cannot be moved",
                  fmt::format("joint '{}'", skeleton_.skeleton.joints[j].name));
    }
    if (isSimilarity(inverse)) return premultiply(inverse, tracks);
    NodeTracks result;
    result.translation.emplace();
    result.rotation.emplace();
    result.scale.emplace();
    std::vector<float> times;
    tracks.addTimes(times);
    sortUnique(times);
    for (const float time : times) {
      const Transform local = decompose(inverse * tracks.at(time, {}).toAffine());
      addKey(*result.translation, time, Vec3f(local.translation.cast<float>()));
      addKey(*result.rotation, time, Eigen::Quaternionf(local.rotation.cast<float>()));
      addKey(*result.scale, time, Vec3f(local.scale.cast<float>()));
    }
    tracks = std::move(result);
  }

  template <typename Value>
  void writeTrack(Index j, const char* path, const Track<Value>& track, const Value& standing) {
    const bool cubic = track.interpolation == Interpolation::kCubic;
    const Value& first = track.values[cubic ? 1 : 0];
    if (!isConstant(track)) return addSampler(j, path, track);
    if (isSame(first, standing) && hold_ == 0) return;
    Track<Value> kept = constantTrack(first);
    if (hold_ > 0) addKey(kept, std::exchange(hold_, 0.0f), first);
    addSampler(j, path, kept);
  }

  // The clip's duration where only constant tracks last that long, else 0.
  static float durationToHold(const Clip& clip) {
    float last = 0;
    forEachTrack(clip, [&](const auto& track) {
      if (!isConstant(track)) last = std::max(last, track.times.back());
    });
    const auto duration = static_cast<float>(clip.duration());
    return last < duration ? duration : 0;
  }

  static bool isSame(const Vec3f& a, const Vec3f& b) { return a.isApprox(b, kStanding); }
  static bool isSame(const Eigen::Quaternionf& a, const Eigen::Quaternionf& b) {
    return std::min((a.coeffs() - b.coeffs()).norm(), (a.coeffs() + b.coeffs()).norm()) < kStanding;
  }

  template <typename Value>
  void addSampler(Index j, const char* path, const Track<Value>& track) {
    std::vector<float> values;
    for (const Value& value : track.values) {
      const auto& numbers = coefficientsOf(value);
      values.insert(values.end(), numbers.data(), numbers.data() + numbers.size());
    }
    const Index times = input(track.times);
    const auto components = static_cast<Index>(coefficientsOf(track.values[0]).size());
    const Index output = shared_ ? shared_->add(values, components) : addFloatAccessor(asset_, values, components);
    const Index sampler = addElement(animation_.samplers, {{}, times, output, track.interpolation});
    const Index node = skeleton_.jointNode[j];
    animation_.channels.push_back({{}, sampler, {{}, node, path}});
    gltf::Node& moved = asset_.document.nodes[node];
    if (moved.matrix) setNodeTransform(moved, nodeLocal_[j].toAffine(), false);
  }

  Index input(const std::vector<float>& times) {
    const auto known = inputs_.find(times);
    if (known != inputs_.end()) return known->second;
    return inputs_[times] = shared_ ? shared_->add(times, 1) : addFloatAccessor(asset_, times, 1, 0, true);
  }

  Asset& asset_;
  const AssetSkeleton& skeleton_;
  Pose nodePose_;                     // in the world
  std::vector<Transform> nodeLocal_;  // #J, as the nodes have it
  std::vector<Affine> frames_;        // #J, above a root joint; identity elsewhere
  UniqueNames names_;
  std::optional<SharedView> shared_;  // of compact clips
  // Of the clip being written:
  gltf::Animation animation_;
  std::map<std::vector<float>, Index> inputs_;
  float hold_ = 0;  // how long the next constant track has to last, so that the clip does
};

}  // namespace

std::vector<Clip> readClips(const Asset& asset, const AssetSkeleton& skeleton, Warnings& warnings) {
  std::vector<Index> all(asset.document.animations.size());
  std::iota(all.begin(), all.end(), Index{0});
  return readClips(asset, skeleton, all, warnings);
}

std::vector<Clip> readClips(const Asset& asset, const AssetSkeleton& skeleton, std::span<const Index> animations,
                            Warnings& warnings) {
  checkKeySharing(asset, animations);
  ClipReader reader(asset, skeleton, warnings);
  std::vector<Clip> clips;
  for (const Index animation : animations) {
    clips.push_back(reader.read(animation));
    checkClip(clips.back(), skeleton.skeleton);
  }
  return clips;
}

std::vector<std::string> addClips(Asset& asset, const AssetSkeleton& skeleton, std::span<const Clip> clips,
                                  const ClipWriteOptions& options) {
  const Index nodeCount = asset.document.nodeCount();
  const bool fits =
      skeleton.jointNode.size() == skeleton.skeleton.joints.size() &&
      std::all_of(skeleton.jointNode.begin(), skeleton.jointNode.end(), [&](Index node) { return node < nodeCount; });
  if (!fits) throw Error(ErrorCode::kBadArgument, "the skeleton is not that of this asset");
  ClipWriter writer(asset, skeleton, options);
  std::vector<std::string> names;
  for (const Clip& clip : clips) {
    try {
      checkClip(clip, skeleton.skeleton);
      names.push_back(writer.write(clip));
    } catch (const Error& error) {
      throw error.within(fmt::format("clip '{}'", clip.name));
    }
  }
  return names;
}

}  // namespace limber