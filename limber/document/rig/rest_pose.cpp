#include "limber/document/rig/rest_pose.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include <fmt/format.h>

#include "limber/core/file/read_bounds.h"
#include "limber/document/gltf/accessor.h"
#include "limber/document/gltf/accessor_sweep.h"
#include "limber/document/rig/bind_pose.h"
#include "limber/document/rig/pose_io.h"
#include "limber/document/rig/weight_attributes.h"
#include "limber/document/scene/node_edit.h"

namespace limber {

namespace {

constexpr double kSameNumber = 1e-6;  // relative: transforms of single precision that differ less are one

using Maps = std::vector<Affine>;  // of a mesh's space into itself

Affine inverseOrThrow(const Affine& map, const std::string& where) {
  const Affine inverse = map.inverse(Eigen::Affine);
  if (inverse.matrix().allFinite()) return inverse;
  throw Error(ErrorCode::kBadData, "is made flat by a scale of 0, so the pose cannot become its rest pose", where);
}

bool sameMap(const Affine& a, const Affine& b) {
  const double size = 1 + a.matrix().cwiseAbs().maxCoeff();
  return (a.matrix() - b.matrix()).cwiseAbs().maxCoeff() <= kSameNumber * size;
}

// Where each vertex of a primitive goes: the weighted sum of its joints' maps. Those without weights stay.
Maps vertexMaps(const std::vector<InfluenceSet>& sets, std::size_t vertexCount, const Maps& jointMaps,
                std::size_t& sharedVertices) {
  Maps maps(vertexCount, Affine::Identity());
  for (std::size_t v = 0; v < vertexCount; ++v) {
    double sum = 0;
    Mat4 blended = Mat4::Zero();
    const Affine* first = nullptr;
    bool shared = false;
    for (const InfluenceSet& set : sets) {
      for (std::size_t i = 4 * v; i < 4 * v + 4 && i < set.weights.size(); ++i) {
        const double weight = set.weights[i];
        if (!(weight > 0) || !std::isfinite(weight) || set.joints[i] >= jointMaps.size()) continue;
        const Affine& map = jointMaps[set.joints[i]];
        if (!first) first = &map;
        shared = shared || !sameMap(*first, map);
        sum += weight;
        blended += weight * map.matrix();
      }
    }
    if (!(sum > 0)) continue;
    maps[v].matrix() = blended / sum;
    if (shared) ++sharedVertices;
  }
  return maps;
}

// What a map does to directions at right angles to the surface, which stay on their side where it mirrors.
Mat3 normalMap(const Mat3& linear) {
  return linear.determinant() < 0 ? Mat3(-cofactorsOf(linear)) : cofactorsOf(linear);
}

// Moves the vertices of the meshes that one skin shows. Accessors that several primitives share stay shared.
class VertexMover {
 public:
  VertexMover(Asset& asset, Maps jointMaps) : asset_(asset), jointMaps_(std::move(jointMaps)) {}

  std::size_t sharedVertices() const { return sharedVertices_; }

  void move(gltf::Primitive& primitive) {
    const std::optional<Index> position = primitive.attributes.find("POSITION");
    if (!position) return;
    Source source;
    source.accessors.push_back(*position);
    for (const auto& [name, accessor] : primitive.attributes) {
      if (name.starts_with("JOINTS_") || name.starts_with("WEIGHTS_")) source.accessors.push_back(accessor);
    }
    const auto [maps, isNew] = maps_.try_emplace(source.accessors);
    if (isNew) {
      const Index count = accessorInfo(asset_, *position).count;
      maps->second = vertexMaps(readInfluenceSets(asset_, primitive), count, jointMaps_, sharedVertices_);
    }
    source.maps = &maps->second;
    if (const std::optional<Index> normal = primitive.attributes.find("NORMAL")) {
      source.accessors.push_back(*normal);
      source.normals = readFloats(asset_, *normal);
    }
    moveAttributes(primitive.attributes, source, false);
    for (gltf::Attributes& target : primitive.targets) moveAttributes(target, source, true);
  }

 private:
  struct Source {
    std::vector<Index> accessors;  // that decide how vertices move
    const Maps* maps = nullptr;
    std::vector<float> normals;
  };

  void moveAttributes(gltf::Attributes& attributes, const Source& source, bool morph) {
    for (const char* name : {"POSITION", "NORMAL", "TANGENT"}) {
      const std::optional<Index> accessor = attributes.find(name);
      if (accessor) attributes.set(name, moved(name, *accessor, source, morph));
    }
  }

  Index moved(std::string_view name, Index accessor, const Source& source, bool morph) {
    std::vector<Index> key = source.accessors;
    key.insert(key.end(), {accessor, static_cast<Index>(name.front()), Index{morph}});
    const auto [known, isNew] = done_.try_emplace(std::move(key), kNoIndex);
    if (!isNew) return known->second;
    std::vector<float> values = readFloats(asset_, accessor);
    const Index components = accessorInfo(asset_, accessor).components;
    for (std::size_t v = 0; v < source.maps->size() && components * (v + 1) <= values.size(); ++v) {
      float* value = &values[components * v];
      const Affine& map = (*source.maps)[v];
      const Vec3 before(value[0], value[1], value[2]);
      Vec3 after;
      if (name == "POSITION") {
        after = morph ? Vec3(map.linear() * before) : map * before;
      } else if (name == "NORMAL") {
        const float* normal = morph && source.normals.size() >= 3 * (v + 1) ? &source.normals[3 * v] : value;
        after = normalAfter(map.linear(), before, Vec3(normal[0], normal[1], normal[2]));
      } else {
        after = tangentAfter(map.linear(), before, morph);
        if (!morph && components == 4 && map.linear().determinant() < 0) value[3] = -value[3];
      }
      if (!after.allFinite()) after = before;
      for (int i = 0; i < 3; ++i) value[i] = static_cast<float>(after[i]);
    }
    return known->second = addFloatAccessor(asset_, values, components, kVertexTarget, name == "POSITION");
  }

  // A morph target's difference of normals is scaled as its normal was to be of unit length again.
  static Vec3 normalAfter(const Mat3& linear, const Vec3& before, const Vec3& unit) {
    const Mat3 map = normalMap(linear);
    return map * before / Vec3(map * unit).norm();
  }

  static Vec3 tangentAfter(const Mat3& linear, const Vec3& before, bool morph) {
    const Vec3 turned = linear * before;
    return turned / (morph ? std::cbrt(std::abs(linear.determinant())) : turned.norm());
  }

  Asset& asset_;
  Maps jointMaps_;
  std::map<std::vector<Index>, Maps> maps_;
  std::map<std::vector<Index>, Index> done_;
  std::size_t sharedVertices_ = 0;
};

// Binds skins that meshes are shown with where joints are now, their vertices with them.
class Rebinder {
 public:
  // jointWorld  #nodes
  // stretches   by node, of those that have one
  Rebinder(Asset& asset, std::vector<Affine> jointWorld, std::map<Index, Mat3> stretches)
      : asset_(asset), jointWorld_(std::move(jointWorld)), stretches_(std::move(stretches)) {}

  // Returns how many vertices are shared by joints that moved against each other.
  //
  // skinToWorld  #skins: where each skin's mesh space lies in the world; it stays there
  // isMoved      #skins: which are bound anew
  std::size_t run(const std::vector<Affine>& skinToWorld, const std::vector<bool>& isMoved) {
    findUses();
    std::map<Index, VertexMover> movers;
    std::size_t sharedVertices = 0;
    for (const auto& [use, nodes] : nodesOfUse_) {
      const auto [mesh, skin] = use;
      if (!isMoved[skin]) continue;
      auto mover = movers.find(skin);
      if (mover == movers.end()) {
        mover = movers.emplace(skin, VertexMover(asset_, rebind(skin, skinToWorld[skin]))).first;
      }
      const Index target = meshFor(mesh);
      for (gltf::Primitive& primitive : asset_.document.meshes[target].primitives) mover->second.move(primitive);
      for (const Index node : nodes) asset_.document.nodes[node].mesh = target;
    }
    for (const auto& [skin, mover] : movers) sharedVertices += mover.sharedVertices();
    return sharedVertices;
  }

 private:
  void findUses() {
    std::vector<Index> withoutSkin(asset_.document.meshes.size(), 0);
    for (Index n = 0; n < asset_.document.nodeCount(); ++n) {
      const std::optional<Index> mesh = asset_.document.nodes[n].mesh, skin = asset_.document.nodes[n].skin;
      if (!mesh) continue;
      if (skin) {
        nodesOfUse_[{*mesh, *skin}].push_back(n);
      } else {
        withoutSkin[*mesh] = 1;
      }
    }
    usesLeft_ = std::move(withoutSkin);
    for (const auto& use : nodesOfUse_) ++usesLeft_[use.first.first];
  }

  // New inverse bind matrices; returns where each joint takes the vertices bound to it alone.
  Maps rebind(Index skin, const Affine& toWorld) {
    const SkinBinding binding = readSkinBinding(asset_, skin);
    const Affine fromWorld = inverseOrThrow(toWorld, fmt::format("skins[{}]", skin));
    Maps maps;
    std::vector<float> inverseBinds;
    for (std::size_t j = 0; j < binding.joints.size(); ++j) {
      const Affine& joint = jointWorld_[binding.joints[j]];
      const auto stretch = stretches_.find(binding.joints[j]);
      Affine inJoint = binding.inverseBinds[j];
      if (stretch != stretches_.end()) inJoint = stretch->second * inJoint;
      maps.push_back(fromWorld * joint * inJoint);
      const Affine toJoint = inverseOrThrow(joint, fmt::format("nodes[{}]", binding.joints[j])) * toWorld;
      for (int i = 0; i < 16; ++i) inverseBinds.push_back(static_cast<float>(toJoint.matrix()(i % 4, i / 4)));
    }
    asset_.document.skins[skin].inverseBindMatrices = addFloatAccessor(asset_, inverseBinds, 16);
    return maps;
  }

  // A copy while other uses need the mesh as it was, the mesh itself for the last.
  Index meshFor(Index mesh) {
    if (--usesLeft_[mesh] == 0) return mesh;
    return addElement(asset_.document.meshes, gltf::Mesh(asset_.document.meshes[mesh]));
  }

  Asset& asset_;
  std::vector<Affine> jointWorld_;
  std::map<Index, Mat3> stretches_;
  std::map<std::pair<Index, Index>, std::vector<Index>> nodesOfUse_;  // by mesh and skin
  std::vector<Index> usesLeft_;                                       // #meshes, by skins, and one without a skin
};

struct ChangedPart {
  Index node = 0;
  const char* path = "";  // "translation", ...
  std::vector<float> before;
};

template <typename Vector>
bool sameNumbers(const Vector& a, const Vector& b) {
  return (a - b).cwiseAbs().maxCoeff() <= kSameNumber * (1e-1 + a.cwiseAbs().maxCoeff());
}

template <typename Vector>
std::vector<float> floatsOf(const Vector& vector) {
  std::vector<float> values;
  for (Eigen::Index i = 0; i < vector.size(); ++i) values.push_back(static_cast<float>(vector[i]));
  return values;
}

std::vector<ChangedPart> changedParts(const SceneGraph& before, const SceneGraph& after,
                                      const std::vector<Index>& nodes) {
  std::vector<ChangedPart> parts;
  for (const Index n : nodes) {
    const Transform a = decompose(before.local[n]), b = decompose(after.local[n]);
    if (!sameNumbers(a.translation, b.translation)) parts.push_back({n, "translation", floatsOf(a.translation)});
    const Vec4 turned = a.rotation.dot(b.rotation) < 0 ? Vec4(-b.rotation.coeffs()) : b.rotation.coeffs();
    if (!sameNumbers(a.rotation.coeffs(), turned)) {
      parts.push_back({n, "rotation", floatsOf(a.rotation.coeffs())});
    }
    if (!sameNumbers(a.scale, b.scale)) parts.push_back({n, "scale", floatsOf(a.scale)});
  }
  return parts;
}

// What an animation does not move stays where its node has it, and that has changed.
void holdInClips(Asset& asset, const std::vector<ChangedPart>& parts) {
  if (asset.document.animations.empty() || parts.empty()) return;
  const std::vector<float> start = {0};
  const Index input = addFloatAccessor(asset, start, 1, 0, true);
  std::vector<Index> outputs;
  outputs.reserve(parts.size());
  for (const ChangedPart& part : parts) {
    outputs.push_back(addFloatAccessor(asset, part.before, static_cast<Index>(part.before.size())));
  }
  for (gltf::Animation& animation : asset.document.animations) {
    std::set<std::pair<Index, std::string>> driven;
    for (const gltf::AnimationChannel& channel : animation.channels) {
      const ChannelTarget target = channelTarget(channel);
      if (target.node) driven.insert({*target.node, target.path});
    }
    for (std::size_t i = 0; i < parts.size(); ++i) {
      if (driven.count({parts[i].node, parts[i].path}) > 0) continue;
      const Index sampler = addElement(animation.samplers, {{}, input, outputs[i]});
      animation.channels.push_back({{}, sampler, {{}, parts[i].node, parts[i].path}});
    }
  }
}

}  // namespace

void setRestPose(Asset& asset, const AssetSkeleton& skeleton, const Pose& pose, std::span<const Mat3> stretch) {
  if (!stretch.empty() && stretch.size() != skeleton.jointNode.size()) {
    throw Error(ErrorCode::kBadArgument, "a stretch for each joint, or none");
  }
  std::map<Index, Mat3> stretches;
  for (std::size_t j = 0; j < stretch.size(); ++j) stretches.emplace(skeleton.jointNode[j], stretch[j]);
  const AccessorSweep unused(asset);
  const SceneGraph before = readSceneGraph(asset.document);
  const std::vector<Affine> skinToWorld = readBindPose(asset, before).skinToWorld;
  writeNodePose(asset, skeleton, pose);
  const std::vector<bool> all(skinToWorld.size(), true);
  const std::size_t sharedVertices =
      Rebinder(asset, readSceneGraph(asset.document).world, std::move(stretches)).run(skinToWorld, all);
  asset.warnings.add("shared-vertices",
                     "vertices are shared by joints that moved against each other: clips show them a little otherwise",
                     {}, sharedVertices);
  holdInClips(asset, changedParts(before, readSceneGraph(asset.document), skeleton.jointNode));
  unused.sweep(asset);
}

namespace {

bool isFlat(const Affine& map) {
  return !map.inverse(Eigen::Affine).matrix().allFinite();
}

// #skins: of those that were bound elsewhere, which can be bound in the pose?
std::vector<bool> skinsToJoin(const Asset& asset, const BindPose& pose) {
  std::vector<bool> result(asset.document.skins.size(), false);
  for (const Index skin : skinsBoundElsewhere(asset, pose)) {
    const std::vector<Index>& joints = asset.document.skins[skin].joints;
    result[skin] = !isFlat(pose.skinToWorld[skin]) &&
                   std::none_of(joints.begin(), joints.end(), [&](Index node) { return isFlat(pose.nodeWorld[node]); });
  }
  return result;
}

// A few kilobytes of nodes must not ask for gigabytes of copies, one for each skin that a mesh is shown with.
void checkCopies(const gltf::Document& document, const std::vector<bool>& isJoined) {
  std::set<std::pair<Index, Index>> uses;
  std::set<Index> meshes;
  std::uint64_t copied = 0;
  for (const gltf::Node& node : document.nodes) {
    if (!node.mesh || !node.skin || !isJoined[*node.skin] || !uses.insert({*node.mesh, *node.skin}).second) continue;
    if (meshes.insert(*node.mesh).second) continue;
    for (const gltf::Primitive& primitive : document.meshes[*node.mesh].primitives) {
      const std::optional<Index> position = primitive.attributes.find("POSITION");
      if (position) copied += document.accessors[*position].count * (1 + primitive.targets.size());
    }
    if (copied > read_bounds::kRebound.of(0)) {
      throw Error(ErrorCode::kLimit, "has meshes of too many vertices that are shown with several skins");
    }
  }
}

void bindInOne(Asset& asset, const BindPose& pose, const std::vector<bool>& isJoined) {
  checkCopies(asset.document, isJoined);
  const AccessorSweep unused(asset);
  Rebinder(asset, pose.nodeWorld, {}).run(pose.skinToWorld, isJoined);
  asset.warnings.add("joined-binds", "skins that were bound in another pose than their joints are brought to one", {},
                     static_cast<std::size_t>(std::count(isJoined.begin(), isJoined.end(), true)));
  unused.sweep(asset);
}

}  // namespace

bool joinBindPoses(Asset& asset) {
  const BindPose pose = readBindPose(asset, readSceneGraph(asset.document));
  const std::vector<bool> isJoined = skinsToJoin(asset, pose);
  if (std::find(isJoined.begin(), isJoined.end(), true) == isJoined.end()) return false;
  bindInOne(asset, pose, isJoined);
  return true;
}

std::optional<Asset> withJoinedBinds(const Asset& asset) {
  const BindPose pose = readBindPose(asset, readSceneGraph(asset.document));
  const std::vector<bool> isJoined = skinsToJoin(asset, pose);
  if (std::find(isJoined.begin(), isJoined.end(), true) == isJoined.end()) return std::nullopt;
  std::optional<Asset> joined = asset.clone();
  bindInOne(*joined, pose, isJoined);
  return joined;
}

void setNodePose(Asset& asset, const AssetSkeleton& skeleton, const Pose& pose) {
  const SceneGraph before = readSceneGraph(asset.document);
  writeNodePose(asset, skeleton, pose);
  holdInClips(asset, changedParts(before, readSceneGraph(asset.document), skeleton.jointNode));
}

}  // namespace limber
