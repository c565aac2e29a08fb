#include "limber/document/fbx/export_fbx_clips.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <set>

#include "limber/document/clip/clip_io.h"
#include "limber/document/clip/shape_tracks.h"
#include "limber/document/fbx/export_fbx_angles.h"
#include "limber/document/fbx/export_fbx_curves.h"
#include "limber/document/gltf/extensions.h"
#include "limber/document/unique_names.h"
#include "limber/skeleton/motion.h"

namespace limber {

namespace {

// Every model that moves as its node does, as a joint of one skeleton.
AssetSkeleton skeletonOfNodes(const FbxScenePlan& scene) {
  AssetSkeleton result;
  std::map<std::size_t, Index> jointOfModel;
  for (std::size_t m = 0; m < scene.models.size(); ++m) {
    const FbxModelPlan& model = scene.models[m];
    if (!model.node) continue;
    Joint joint;
    joint.name = model.name;
    if (model.parent) joint.parent = jointOfModel.at(*model.parent);
    joint.rest = model.local;
    jointOfModel[m] = result.skeleton.jointCount();
    result.jointNode.push_back(*model.node);
    result.skeleton.joints.push_back(std::move(joint));
  }
  return result;
}

class FbxClipWriter {
 public:
  FbxClipWriter(const Asset& asset, const FbxMovable& movable, const FbxSpace& space, FbxObjectWriter& objects,
                Warnings& warnings)
      : asset_(asset),
        movable_(movable),
        space_(space),
        objects_(objects),
        warnings_(warnings),
        skeleton_(skeletonOfNodes(movable.scene)) {}

  std::vector<FbxStack> write(const std::vector<Index>& chosen) {
    std::vector<FbxStack> stacks;
    if (chosen.empty()) return stacks;
    tellOfPointers(chosen);
    std::vector<Clip> clips;
    if (!skeleton_.jointNode.empty()) clips = readClips(asset_, skeleton_, warnings_);
    clips.resize(asset_.document.animations.size());
    std::vector<ClipCurves> curves;
    for (const Index c : chosen) curves.push_back(curvesOf(clips[c]));
    findMoved(chosen, curves);
    for (std::size_t i = 0; i < chosen.size(); ++i) {
      stacks.push_back(writeClip(chosen[i], denseFrameRateOf(clips[chosen[i]]), curves[i]));
    }
    return stacks;
  }

 private:
  void tellOfPointers(const std::vector<Index>& chosen) {
    for (const Index c : chosen) {
      for (const gltf::AnimationChannel& channel : asset_.document.animations[c].channels) {
        if (animationPointer(channel.target) == nullptr) continue;
        warnings_.add("animation-pointers", "what a clip changes beside nodes and blend shapes is left out",
                      asset_.document.animations[c].name);
      }
    }
  }

  enum Part { kTranslation, kRotation, kScaling };
  using ClipCurves = std::map<std::pair<Index, Part>, FbxKeys>;  // by joint

  ClipCurves curvesOf(const Clip& clip) const {
    ClipCurves curves;
    for (const auto& track : clip.translations) {
      FbxKeys& keys = curves[{track.joint, kTranslation}] = fbxKeys(track);
      for (Vec3& value : keys.values) {
        Transform transform;
        transform.translation = value;
        value = space_.local(transform, !modelOf(track.joint).parent).translation;
      }
    }
    for (const Track<Eigen::Quaternionf>& track : clip.rotations) {
      const Quat turn = space_.local(Transform(), !modelOf(track.joint).parent).rotation;
      curves[{track.joint, kRotation}] = fbxKeys(track, turn);
    }
    for (const Track<Vec3f>& track : clip.scales) curves[{track.joint, kScaling}] = fbxKeys(track);
    return curves;
  }

  // What any of the clips moves, all of them say: programs that go from one clip to another leave the rest as it was.
  void findMoved(const std::vector<Index>& chosen, const std::vector<ClipCurves>& clips) {
    for (const ClipCurves& curves : clips) {
      for (const auto& [of, keys] : curves) {
        const Vec3f restDirection = standing(of.first, of.second).cast<float>();
        const bool moves = std::any_of(keys.values.begin(), keys.values.end(),
                                       [&](const Vec3& value) { return value.cast<float>() != restDirection; });
        if (moves) moved_.insert(of);
      }
    }
    for (const Index c : chosen) {
      for (const gltf::AnimationChannel& channel : asset_.document.animations[c].channels) {
        if (channel.target.node && channel.target.path == "weights") movedShapes_.insert(*channel.target.node);
      }
    }
  }

  const FbxModelPlan& modelOf(Index joint) const {
    return movable_.scene.models[*movable_.scene.modelOfNode[skeleton_.jointNode[joint]]];
  }

  Vec3 standing(Index joint, Part part) const {
    const FbxModelPlan& model = modelOf(joint);
    const Transform local = space_.local(model.local, !model.parent);
    return part == kTranslation ? local.translation : part == kRotation ? eulerDegrees(local.rotation) : local.scale;
  }

  FbxStack writeClip(Index number, double rate, const ClipCurves& curves) {
    const std::string& own = asset_.document.animations[number].name;
    FbxStack stack{names_.add(own.empty() ? "clip" : own), 0, rate};
    const FbxId stackId = objects_.newId();
    FbxObjectWriter::Made layer = objects_.make("AnimationLayer", stack.name, "AnimLayer", "");
    layer_ = layer.id;
    FbxPropertyWriter(layer.record).number("Weight", 100);
    objects_.connect(layer_, stackId);
    duration_ = 0;
    for (const auto& [of, keys] : curves) duration_ = std::max(duration_, keys.times.back());
    for (const auto& of : moved_) {
      const auto known = curves.find(of);
      writeCurves(of.first, of.second,
                  known != curves.end() ? known->second : FbxKeys{{0}, {standing(of.first, of.second)}, false});
    }
    for (std::size_t m = 0; m < movable_.scene.models.size(); ++m) {
      if (const FbxGeometry* geometry = movable_.geometries[m]) writeShapes(m, *geometry, number);
    }
    stack.duration = duration_;
    writeStack(stack, stackId);
    return stack;
  }

  void writeStack(const FbxStack& stack, FbxId id) {
    FbxObjectWriter::Made made = objects_.make("AnimationStack", stack.name, "AnimStack", "");
    // Its number was needed before it: curves come first, and their last key ends it.
    made.record.values[0] = id;
    FbxPropertyWriter properties(made.record);
    properties.time("LocalStart", 0);
    properties.time("LocalStop", fbxTime(stack.duration));
    properties.time("ReferenceStart", 0);
    properties.time("ReferenceStop", fbxTime(stack.duration));
  }

  void writeCurves(Index joint, Part part, const FbxKeys& keys) {
    constexpr std::array<std::array<const char*, 2>, 3> kNames = {
        {{"T", "Lcl Translation"}, {"R", "Lcl Rotation"}, {"S", "Lcl Scaling"}}};
    const auto& [name, property] = kNames[part];
    const FbxId model = movable_.models[*movable_.scene.modelOfNode[skeleton_.jointNode[joint]]];
    FbxObjectWriter::Made node = objects_.make("AnimationCurveNode", name, "AnimCurveNode", "");
    const FbxId id = node.id;
    FbxPropertyWriter properties(node.record);
    constexpr std::array<const char*, 3> kAxes = {"d|X", "d|Y", "d|Z"};
    for (int axis = 0; axis < 3; ++axis) {
      properties.number(kAxes[static_cast<std::size_t>(axis)], static_cast<float>(keys.values[0][axis]));
    }
    objects_.connect(id, layer_);
    objects_.connect(id, model, property);
    for (int axis = 0; axis < 3; ++axis) {
      writeCurve(keys, axis, id, kAxes[static_cast<std::size_t>(axis)]);
    }
  }

  // One component of keys; a single key where it is constant.
  void writeCurve(const FbxKeys& keys, int component, FbxId node, const char* property) {
    std::vector<std::int64_t> times;
    std::vector<float> values;
    for (std::size_t k = 0; k < keys.times.size(); ++k) {
      times.push_back(fbxTime(keys.times[k]));
      values.push_back(static_cast<float>(keys.values[k][component]));
    }
    const bool isConstant = std::all_of(values.begin(), values.end(), [&](float value) { return value == values[0]; });
    if (isConstant) {
      times.resize(1);
      values.resize(1);
    }
    constexpr std::int32_t kConstant = 2, kLinear = 4;  // of the SDK's FbxAnimCurveDef
    const auto count = static_cast<std::int32_t>(times.size());
    FbxObjectWriter::Made curve = objects_.make("AnimationCurve", "", "AnimCurve", "");
    addRecord(curve.record, "Default", {double{values[0]}});
    addRecord(curve.record, "KeyVer", {std::int32_t{4008}});
    addRecord(curve.record, "KeyTime", {std::move(times)});
    addRecord(curve.record, "KeyValueFloat", {std::move(values)});
    addRecord(curve.record, "KeyAttrFlags", {std::vector<std::int32_t>{keys.isStepped ? kConstant : kLinear}});
    addRecord(curve.record, "KeyAttrDataFloat", {std::vector<float>(4, 0)});
    addRecord(curve.record, "KeyAttrRefCount", {std::vector<std::int32_t>{count}});
    objects_.connect(curve.id, node, property);
  }

  void writeShapes(std::size_t model, const FbxGeometry& geometry, Index clip) {
    const Index meshNode = *movable_.scene.models[model].meshNode;
    if (geometry.shapeChannels.empty() || movedShapes_.count(meshNode) == 0) return;
    const std::vector<Track<float>> tracks = shapeTracks(asset_, meshNode, geometry.shapeChannels.size(), clip);
    for (std::size_t s = 0; s < tracks.size(); ++s) {
      const Track<Vec3f> percent = inPercent(tracks[s]);
      if (percent.times.empty()) continue;
      const FbxKeys keys = fbxKeys(percent);
      duration_ = std::max(duration_, keys.times.back());
      FbxObjectWriter::Made node = objects_.make("AnimationCurveNode", "DeformPercent", "AnimCurveNode", "");
      const FbxId id = node.id;
      FbxPropertyWriter(node.record).number("d|DeformPercent", static_cast<float>(keys.values[0].x()));
      objects_.connect(id, layer_);
      objects_.connect(id, geometry.shapeChannels[s], "DeformPercent");
      writeCurve(keys, 0, id, "d|DeformPercent");
    }
  }

  // Keys that are not finite or not in order are left out, as readClips does.
  Track<Vec3f> inPercent(const Track<float>& track) {
    const std::size_t perKey = track.interpolation == Interpolation::kCubic ? 3 : 1;
    Track<Vec3f> percent{0, track.interpolation, {}, {}};
    for (std::size_t k = 0; k < track.times.size(); ++k) {
      bool isValid = std::isfinite(track.times[k]) && (percent.times.empty() || track.times[k] > percent.times.back());
      for (std::size_t v = k * perKey; v < (k + 1) * perKey; ++v) isValid = isValid && std::isfinite(track.values[v]);
      if (!isValid) {
        warnings_.add("invalid-keys", "animation keys that are not finite or not in order are left out");
        continue;
      }
      percent.times.push_back(track.times[k]);
      for (std::size_t v = k * perKey; v < (k + 1) * perKey; ++v)
        percent.values.emplace_back(100 * track.values[v], 0, 0);
    }
    return percent;
  }

  const Asset& asset_;
  const FbxMovable& movable_;
  const FbxSpace& space_;
  FbxObjectWriter& objects_;
  Warnings& warnings_;
  AssetSkeleton skeleton_;
  UniqueNames names_;
  std::set<std::pair<Index, Part>> moved_;  // by any of the clips
  std::set<Index> movedShapes_;             // of nodes
  FbxId layer_ = 0;                         // of the clip that is being written
  double duration_ = 0;                     // likewise
};

}  // namespace

std::vector<FbxStack> writeFbxClips(const Asset& asset, const std::vector<Index>& clips, const FbxMovable& movable,
                                    const FbxSpace& space, FbxObjectWriter& objects, Warnings& warnings) {
  return FbxClipWriter(asset, movable, space, objects, warnings).write(clips);
}

}  // namespace limber
