#include "limber/document/vrm/vrma_write.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <set>
#include <utility>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "limber/core/rotation.h"
#include "limber/core/text/names.h"
#include "limber/document/clip/clip_io.h"
#include "limber/document/clip/motion_io.h"
#include "limber/document/gltf/accessor.h"
#include "limber/document/gltf/extensions.h"
#include "limber/document/scene/humanoid_nodes.h"
#include "limber/document/scene/node_edit.h"
#include "limber/document/vrm/loose_json.h"
#include "limber/document/vrm/vrm_expressions.h"
#include "limber/skeleton/chain.h"

namespace limber {

namespace {

constexpr double kRate = 60;            // a second, between keys where a bone turns otherwise than evenly
constexpr double kSameTurn = 1e-7;      // radians
constexpr double kBeforeStep = 1e-4;    // seconds
constexpr double kMaxBetween = 3600;    // moments between two keys, however far apart
constexpr double kLostPosition = 1e-3;  // of the skeleton's size: what keys 60 times a second miss between them

// A skeleton's joints at one moment, in VRM's space: how far each is turned from its rest pose, and where it is.
struct Moment {
  std::vector<Quat> turns;
  std::vector<Vec3> positions;
};

std::vector<Quat> rotationsOf(const Skeleton& skeleton, const Pose& pose) {
  std::vector<Quat> rotations;
  for (Index j = 0; j < skeleton.jointCount(); ++j) {
    const std::optional<Index> parent = skeleton.joints[j].parent;
    const Quat above = parent ? rotations[*parent] : Quat::Identity();
    rotations.push_back((above * pose.locals[j].rotation).normalized());
  }
  return rotations;
}

class AnimationMaker {
 public:
  AnimationMaker(const Skeleton& skeleton, const Clip& clip, const TPose& rest, std::span<const HumanoidJoint> bones)
      : skeleton_(skeleton), clip_(clip), rest_(rest), bones_(bones), restRotations_(rotationsOf(skeleton, rest.pose)) {
    for (std::size_t b = 0; b < bones.size(); ++b) {
      numberOf_[bones[b].bone] = b;
      std::optional<std::string_view> above = humanoidParent(bones[b].bone);
      while (above && numberOf_.count(*above) == 0) above = humanoidParent(*above);
      parents_.push_back(above ? std::optional(numberOf_[*above]) : std::nullopt);
    }
  }

  Asset make(std::span<const ExpressionTrack> expressions) {
    gltf::Document& document = asset_.document;
    document.about.generator = "limber";
    document.scene = addElement(document.scenes, {});
    gltf::Animation& animation = document.animations.emplace_back();
    animation.name = clip_.name;
    addBones();
    collectMoments();
    for (std::size_t b = 0; b < bones_.size(); ++b) addBoneTracks(b);
    Json extension = {{"specVersion", "1.0"}, {"humanoid", {{"humanBones", Json::object()}}}};
    for (std::size_t b = 0; b < bones_.size(); ++b) {
      extension["humanoid"]["humanBones"][std::string(bones_[b].bone)] = {{"node", b}};
    }
    for (const ExpressionTrack& expression : expressions) addExpression(expression, extension);
    changeExtension(document, kVrmAnimationName) = std::move(extension);
    declareExtension(document, kVrmAnimationName);
    warnOfLostPositions();
    return std::move(asset_);
  }

 private:
  // Nodes are numbered as bones are.
  void addBones() {
    const std::vector<Vec3> positions = posePositions(skeleton_, rest_.pose);
    gltf::Document& document = asset_.document;
    for (std::size_t b = 0; b < bones_.size(); ++b) {
      Vec3 position = rest_.toVrm * positions[bones_[b].joint];
      if (parents_[b]) position -= rest_.toVrm * positions[bones_[*parents_[b]].joint];
      gltf::Node node;
      node.name = bones_[b].bone;
      setNodeTransform(node, Affine(Eigen::Translation3d(position)), false);
      const Index number = addElement(document.nodes, std::move(node));
      if (parents_[b]) {
        document.nodes[*parents_[b]].children.push_back(number);
      } else {
        document.scenes[0].nodes.push_back(number);
      }
    }
  }

  // The joints that turn a bone against the one above: itself and those between; of the hips all above. Of a bone that
  // hangs elsewhere all above both.
  std::vector<Index> jointsOf(std::size_t b) const {
    std::vector<Index> joints;
    const std::optional<Index> end = parents_[b] ? std::optional(bones_[*parents_[b]].joint) : std::nullopt;
    const auto addUpward = [&](std::optional<Index> j) {
      for (; j && j != end; j = skeleton_.joints[*j].parent) joints.push_back(*j);
    };
    addUpward(bones_[b].joint);
    if (end && !isAncestorOrSelf(skeleton_, *end, bones_[b].joint)) {
      joints.push_back(*end);
      addUpward(skeleton_.joints[*end].parent);
    }
    return joints;
  }

  template <typename Value>
  static void addKeys(const std::vector<Track<Value>>& tracks, const std::vector<Index>& joints, bool isAlone,
                      std::set<float>& times, Interpolation& interpolation) {
    for (const Track<Value>& track : tracks) {
      if (std::find(joints.begin(), joints.end(), track.joint) == joints.end()) continue;
      times.insert(track.times.begin(), track.times.end());
      if (isAlone && track.interpolation != Interpolation::kCubic) {
        interpolation = track.interpolation;
        continue;
      }
      for (std::size_t k = 1; k < track.times.size(); ++k) {
        const double from = track.times[k - 1], to = track.times[k];
        if (track.interpolation == Interpolation::kStep) {
          if (to - kBeforeStep > from) times.insert(static_cast<float>(to - kBeforeStep));
          continue;
        }
        const double steps = std::min(std::ceil((to - from) * kRate), kMaxBetween);
        for (int i = 1; i < steps; ++i) times.insert(static_cast<float>(from + (to - from) * i / steps));
      }
    }
  }

  // The keys of a bone's rotation, or of the hips' position, with interpolation: its joint's where that is the only
  // one.
  struct Keys {
    std::set<float> times;
    Interpolation interpolation = Interpolation::kLinear;
  };
  Keys turnKeys(std::size_t b) const {
    Keys keys;
    const std::vector<Index> joints = jointsOf(b);
    std::vector<Index> moving;
    for (const auto& track : clip_.rotations) {
      if (std::find(joints.begin(), joints.end(), track.joint) != joints.end()) moving.push_back(track.joint);
    }
    addKeys(clip_.rotations, joints, moving.size() <= 1, keys.times, keys.interpolation);
    return keys;
  }
  Keys hipsKeys() const {
    Keys keys;
    const std::vector<Index> joints = jointsOf(0);
    const std::vector<Index> above(joints.begin() + 1, joints.end());
    const auto moves = [&](const auto& tracks) {
      return std::any_of(tracks.begin(), tracks.end(), [&](const auto& track) {
        return std::find(above.begin(), above.end(), track.joint) != above.end();
      });
    };
    const bool isAlone = !moves(clip_.translations) && !moves(clip_.rotations) && !moves(clip_.scales);
    addKeys(clip_.translations, joints, isAlone, keys.times, keys.interpolation);
    addKeys(clip_.rotations, above, isAlone, keys.times, keys.interpolation);
    addKeys(clip_.scales, above, isAlone, keys.times, keys.interpolation);
    return keys;
  }

  void collectMoments() {
    hipsKeys_ = hipsKeys();
    std::set<float> all = hipsKeys_.times;
    all.insert(0);
    for (std::size_t b = 0; b < bones_.size(); ++b) {
      turnKeys_.push_back(turnKeys(b));
      all.insert(turnKeys_.back().times.begin(), turnKeys_.back().times.end());
    }
    Pose pose = restPose(skeleton_);
    for (const float time : all) {
      sampleClip(clip_, time, pose);
      const std::vector<Quat> rotations = rotationsOf(skeleton_, pose);
      const std::vector<Vec3> positions = posePositions(skeleton_, pose);
      Moment moment;
      for (const HumanoidJoint& bone : bones_) {
        moment.turns.push_back(
            (rest_.toVrm * rotations[bone.joint] * restRotations_[bone.joint].conjugate() * rest_.toVrm.conjugate())
                .normalized());
      }
      moment.positions.push_back(rest_.toVrm * positions[bones_[0].joint]);
      moments_.emplace(time, std::move(moment));
    }
  }

  Quat turnAt(float time, std::size_t b) const {
    const Moment& moment = moments_.at(time);
    return parents_[b] ? Quat(moment.turns[*parents_[b]].conjugate() * moment.turns[b]) : moment.turns[b];
  }

  void addBoneTracks(std::size_t b) {
    Keys keys = turnKeys_[b];
    if (keys.times.empty()) keys.times.insert(0);
    std::vector<float> times, turns;
    Quat before = Quat::Identity();
    bool turnsAtAll = false;
    for (const float time : keys.times) {
      Quat turn = turnAt(time, b).normalized();
      if (turn.dot(before) < 0) turn.coeffs() = -turn.coeffs();
      turnsAtAll = turnsAtAll || angleBetween(turn, Quat::Identity()) > kSameTurn;
      before = turn;
      times.push_back(time);
      for (int i = 0; i < 4; ++i) turns.push_back(static_cast<float>(turn.coeffs()[i]));
    }
    if (turnsAtAll) addChannel(static_cast<Index>(b), "rotation", times, turns, 4, keys.interpolation);
    if (b == 0) addHipsTranslation();
  }

  void addHipsTranslation() {
    Keys keys = hipsKeys_;
    if (keys.times.empty()) keys.times.insert(0);
    std::vector<float> times, positions;
    for (const float time : keys.times) {
      times.push_back(time);
      for (int i = 0; i < 3; ++i) positions.push_back(static_cast<float>(moments_.at(time).positions[0][i]));
    }
    addChannel(0, "translation", times, positions, 3, keys.interpolation);
  }

  // In glTF an expression's weight is where a node of its own is along X.
  void addExpression(const ExpressionTrack& expression, Json& extension) {
    gltf::Node node;
    node.name = expression.name;
    const Index number = addElement(asset_.document.nodes, std::move(node));
    asset_.document.scenes[0].nodes.push_back(number);
    std::vector<float> values;
    for (const float weight : expression.weight.values) values.insert(values.end(), {weight, 0, 0});
    addChannel(number, "translation", expression.weight.times, values, 3, expression.weight.interpolation);
    extension["expressions"][expression.isPreset ? "preset" : "custom"][expression.name] = {{"node", number}};
  }

  void addChannel(Index node, const char* path, const std::vector<float>& times, const std::vector<float>& values,
                  Index components, Interpolation interpolation) {
    const auto [input, isNew] = inputs_.try_emplace(times, kNoIndex);
    if (isNew) input->second = addFloatAccessor(asset_, times, 1, 0, true);
    gltf::Animation& animation = asset_.document.animations.front();
    const Index output = addFloatAccessor(asset_, values, components);
    const Index sampler = addElement(animation.samplers, {{}, input->second, output, interpolation});
    animation.channels.push_back({{}, sampler, {{}, node, path}});
  }

  // How far joints are, as the file has them, from where the clip has them.
  struct Miss {
    double distance = 0;
    std::size_t bone = 0;
    double seconds = 0;
  };

  Miss largestMiss() const {
    Warnings ignored;
    const AssetSkeleton made = animatedSkeleton(asset_);
    const std::vector<Clip> clips = readClips(asset_, made, ignored);
    std::set<float> times;
    for (const auto& [time, moment] : moments_) times.insert(time);
    for (const auto* tracks : {&clip_.translations, &clip_.scales}) {
      for (const Track<Vec3f>& track : *tracks) times.insert(track.times.begin(), track.times.end());
    }
    Pose pose = restPose(skeleton_), shown = restPose(made.skeleton);
    Miss largest;
    for (const double seconds : times) {
      sampleClip(clip_, seconds, pose);
      if (!clips.empty()) sampleClip(clips.front(), seconds, shown);
      const std::vector<Vec3> wanted = posePositions(skeleton_, pose), positions = posePositions(made.skeleton, shown);
      for (Index j = 0; j < made.skeleton.jointCount(); ++j) {
        const std::size_t bone = made.jointNode[j];
        const double distance = (positions[j] - rest_.toVrm * wanted[bones_[bone].joint]).norm();
        if (distance > largest.distance) largest = {distance, bone, seconds};
      }
    }
    return largest;
  }

  void warnOfLostPositions() {
    Box box;
    for (const Vec3& position : posePositions(skeleton_, rest_.pose)) box.add(position);
    const Miss largest = largestMiss();
    if (largest.distance <= kLostPosition * box.diagonal()) return;
    asset_.warnings.add(
        "vrma-lengths",
        fmt::format("lengths and scales of bones that change are left out: joints are up to {:.2g} m from where the "
                    "clip has them ({} at {:.2f} s)",
                    largest.distance, bones_[largest.bone].bone, largest.seconds),
        clip_.name);
  }

  const Skeleton& skeleton_;
  const Clip& clip_;
  const TPose& rest_;
  std::span<const HumanoidJoint> bones_;  // the hips first
  std::vector<Quat> restRotations_;
  std::map<std::string_view, std::size_t> numberOf_;
  std::vector<std::optional<std::size_t>> parents_;  // #bones
  Keys hipsKeys_;
  std::vector<Keys> turnKeys_;  // #bones
  std::map<float, Moment> moments_;
  std::map<std::vector<float>, Index> inputs_;
  Asset asset_;
};

// The weights of one blend shape of a node in an animation; none where it does not move there.
std::optional<Track<float>> shapeTrack(const Asset& asset, const gltf::Animation& animation, Index node, Index shape) {
  const std::optional<Index> mesh = asset.document.nodes[node].mesh;
  if (!mesh || asset.document.meshes[*mesh].primitives.empty()) return std::nullopt;
  const std::size_t count = asset.document.meshes[*mesh].primitives.front().targets.size();
  for (const gltf::AnimationChannel& channel : animation.channels) {
    if (channel.target.node != node || channel.target.path != "weights" || shape >= count) continue;
    const gltf::AnimationSampler& sampler = animation.samplers[channel.sampler];
    Track<float> track{0, sampler.interpolation, readFloats(asset, sampler.input), {}};
    const std::vector<float> values = readFloats(asset, sampler.output);
    const std::size_t perKey = sampler.interpolation == Interpolation::kCubic ? 3 : 1;
    if (track.times.empty() || values.size() < track.times.size() * perKey * count) return std::nullopt;
    for (std::size_t k = 0; k < track.times.size() * perKey; ++k) track.values.push_back(values[k * count + shape]);
    return track;
  }
  return std::nullopt;
}

bool isSame(const Track<float>& a, const Track<float>& b) {
  constexpr float kSameWeight = 1e-5f;
  return a.interpolation == b.interpolation && a.times == b.times &&
         std::equal(a.values.begin(), a.values.end(), b.values.begin(), b.values.end(),
                    [](float x, float y) { return std::abs(x - y) <= kSameWeight; });
}

// What moves all of an expression's blend shapes, if they move as one.
std::optional<Track<float>> trackOf(const Asset& asset, const gltf::Animation& animation, const Json& expression) {
  std::optional<Track<float>> common;
  for (const Json& bind : listIn(expression, "morphTargetBinds")) {
    const std::optional<Index> node = indexIn(bind, "node", asset.document.nodes.size());
    const std::optional<Index> shape = indexIn(bind, "index", kNoIndex);
    const double weight = numberIn(bind, "weight", 1);
    if (!node || !shape || !(weight > 0)) return std::nullopt;
    std::optional<Track<float>> track = shapeTrack(asset, animation, *node, *shape);
    if (!track) return std::nullopt;
    for (float& value : track->values) value = static_cast<float>(value / weight);
    if (common && !isSame(*common, *track)) return std::nullopt;
    if (!common) common = std::move(track);
  }
  return common;
}

// Such a file has a field of its own for gaze ("lookAt"), and forbids it elsewhere.
bool isEye(std::string_view bone) {
  return bone == "leftEye" || bone == "rightEye";
}
bool isGaze(const ExpressionTrack& expression) {
  return expression.isPreset && expression.name.starts_with("look");  // lookUp, lookDown, lookLeft, lookRight
}

}  // namespace

std::vector<ExpressionTrack> expressionTracks(const Asset& asset, Index animation) {
  const Json* vrm = extensionOf(asset.document, kVrmName);
  const Json* kept = vrm != nullptr ? member(*vrm, "expressions") : nullptr;
  const Json expressions = kept != nullptr ? *kept : expressionsByName(asset.document);
  std::vector<ExpressionTrack> tracks;
  for (const bool isPreset : {true, false}) {
    const Json* named = member(expressions, isPreset ? "preset" : "custom");
    if (named == nullptr || !named->is_object()) continue;
    for (const auto& [name, expression] : named->items()) {
      std::optional<Track<float>> track = trackOf(asset, asset.document.animations[animation], expression);
      if (track) tracks.push_back({name, isPreset, std::move(*track)});
    }
  }
  return tracks;
}

Asset vrmAnimation(const Skeleton& skeleton, const Clip& clip, const TPose& rest, std::span<const HumanoidJoint> bones,
                   std::span<const ExpressionTrack> expressions) {
  std::vector<HumanoidJoint> kept;
  std::size_t leftOut = 0;
  for (const HumanoidJoint& bone : bones) {
    if (!isEye(bone.bone)) {
      kept.push_back(bone);
    } else if (std::any_of(clip.rotations.begin(), clip.rotations.end(),
                           [&](const auto& track) { return track.joint == bone.joint && track.times.size() > 1; })) {
      ++leftOut;
    }
  }
  std::vector<ExpressionTrack> shown;
  for (const ExpressionTrack& expression : expressions) {
    if (isGaze(expression)) {
      ++leftOut;
    } else {
      shown.push_back(expression);
    }
  }
  Asset made = AnimationMaker(skeleton, clip, rest, kept).make(shown);
  made.warnings.add("vrma-gaze", "turns of the eyes, and expressions of where they look, are left out", clip.name,
                    leftOut);
  return made;
}

bool isVrmaFormat(const std::filesystem::path& path) {
  return lowerExtension(path) == ".vrma";
}

}  // namespace limber
