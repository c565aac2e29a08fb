#include "limber/document/rig/root_joint.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "limber/document/clip/motion_io.h"
#include "limber/document/gltf/accessor.h"
#include "limber/document/gltf/accessor_sweep.h"
#include "limber/document/rig/bind_pose.h"
#include "limber/document/rig/joint_radius.h"
#include "limber/document/scene/node_edit.h"
#include "limber/document/scene/scene_graph.h"
#include "limber/document/unique_names.h"

namespace limber {

namespace {

constexpr double kOnGround = 0.05;   // of the skeleton's size
constexpr double kSameScale = 1e-6;  // relative: of one frame's three scales

struct SkeletonRoot {
  Index joint = 0, node = 0;
  Affine change = Affine::Identity();  // of the node's local transform
};

std::vector<SkeletonRoot> rootsOf(const AssetSkeleton& skeleton) {
  std::vector<SkeletonRoot> roots;
  for (Index j = 0; j < skeleton.skeleton.jointCount(); ++j) {
    if (!skeleton.skeleton.joints[j].parent) roots.push_back({j, skeleton.jointNode[j]});
  }
  return roots;
}

// The nearest node above all of them; none where it is the scene.
std::optional<Index> commonParent(const SceneGraph& graph, const std::vector<SkeletonRoot>& roots) {
  std::vector<std::size_t> times(graph.nodeCount(), 0);
  for (const SkeletonRoot& root : roots) {
    for (std::optional<Index> n = graph.parent[root.node]; n; n = graph.parent[*n]) ++times[*n];
  }
  for (std::optional<Index> n = graph.parent[roots.front().node]; n; n = graph.parent[*n]) {
    if (times[*n] == roots.size()) return n;
  }
  return std::nullopt;
}

// Does it move, turn and scale evenly, and no more?
bool keepsForm(const Affine& frame, Transform& parts) {
  bool sheared = false;
  parts = decompose(frame, &sheared);
  const double scale = parts.scale.x();
  return !sheared && scale > 0 && (parts.scale.array() - scale).abs().maxCoeff() < kSameScale * scale;
}

[[noreturn]] void refuse(const Asset& asset, Index node, const char* what) {
  throw Error(ErrorCode::kUnsupported, what, fmt::format("nodes[{}] '{}'", node, asset.document.nodes[node].name),
              "write the clips by limber convert first, which brings them to joints alone");
}

// The local transform, below a node at `frame`, of a node at the world's origin with the world's orientation.
Affine localOfRoot(const Asset& asset, std::optional<Index> parent, const Affine& frame) {
  const Affine inverse = frame.inverse(Eigen::Affine);
  if (!inverse.matrix().allFinite()) {
    throw Error(ErrorCode::kBadData, "has a scale of 0, so no joint can hang on it",
                fmt::format("nodes[{}] '{}'", *parent, asset.document.nodes[*parent].name));
  }
  Transform parts;
  Affine local = Affine::Identity();
  if (keepsForm(frame, parts)) local.linear() = parts.rotation.inverse().toRotationMatrix();
  local.translation() = inverse.translation();
  return local;
}

// What the nodes from below `above` down to the one that `node` hangs on do to it.
Affine frameBetween(const Asset& asset, const SceneGraph& graph, const std::vector<bool>& animated,
                    std::optional<Index> above, Index node) {
  Affine frame = Affine::Identity();
  for (std::optional<Index> n = graph.parent[node]; n != above; n = graph.parent[*n]) {
    if (animated[*n]) refuse(asset, *n, "moves a part of the skeleton, so that no joint can be put above the whole");
    frame = graph.local[*n] * frame;
  }
  return frame;
}

// `change` times what a channel's sampler says, as an accessor of its own.
Index changedOutput(Asset& asset, const gltf::AnimationSampler& sampler, std::string_view path,
                    const Transform& change) {
  std::vector<float> values = readFloats(asset, sampler.output);
  const Index components = path == "rotation" ? 4 : 3;
  const bool cubic = sampler.interpolation == Interpolation::kCubic;
  for (std::size_t v = 0; (v + 1) * components <= values.size(); ++v) {
    float* value = values.data() + v * components;
    if (path == "rotation") {
      Eigen::Map<Vec4f> turn(value);
      turn = (change.rotation * Quat(Vec4(turn.cast<double>()))).coeffs().cast<float>();
    } else {
      Eigen::Map<Vec3f> vector(value);
      Vec3 changed = vector.cast<double>() * change.scale.x();
      if (path == "translation") {
        changed = change.rotation * changed;
        if (!cubic || v % 3 == 1) changed += change.translation;
      }
      vector = changed.cast<float>();
    }
  }
  return addFloatAccessor(asset, values, components);
}

void changeChannels(Asset& asset, const SkeletonRoot& root) {
  Transform change;
  keepsForm(root.change, change);
  for (std::size_t a = 0; a < asset.document.animations.size(); ++a) {
    bool any = false;
    for (std::size_t c = 0; c < asset.document.animations[a].channels.size(); ++c) {
      const gltf::AnimationChannel channel = asset.document.animations[a].channels[c];
      const ChannelTarget target = channelTarget(channel);
      if (target.node != root.node || target.path == "weights") continue;
      gltf::AnimationSampler sampler = asset.document.animations[a].samplers[channel.sampler];
      sampler.output = changedOutput(asset, sampler, target.path, change);
      gltf::Animation& animation = asset.document.animations[a];
      animation.channels[c].sampler = addElement(animation.samplers, std::move(sampler));
      any = true;
    }
    if (any) removeUnusedSamplers(asset.document.animations[a]);
  }
}

// Removes the roots from their parents' children; the new node takes the list position of the first.
void hangRoots(gltf::Document& document, const SceneGraph& graph, const std::vector<SkeletonRoot>& roots,
               std::optional<Index> parent, Index node) {
  const auto isRoot = [&](Index n) {
    return std::any_of(roots.begin(), roots.end(), [&](const SkeletonRoot& root) { return root.node == n; });
  };
  const auto takeOut = [&](std::vector<Index>& list, bool wanted) {
    const auto first = std::find_if(list.begin(), list.end(), isRoot);
    const auto index = first - list.begin();
    if (first == list.end()) return;
    std::erase_if(list, isRoot);
    if (wanted) list.insert(list.begin() + index, node);
  };
  for (Index n = 0; n < node; ++n) takeOut(document.nodes[n].children, parent == n);
  for (gltf::Scene& scene : document.scenes) {
    const bool shows = std::any_of(roots.begin(), roots.end(), [&](const SkeletonRoot& root) {
      Index top = root.node;
      while (graph.parent[top]) top = *graph.parent[top];
      return std::find(scene.nodes.begin(), scene.nodes.end(), top) != scene.nodes.end();
    });
    takeOut(scene.nodes, !parent);
    const bool placed = std::find(scene.nodes.begin(), scene.nodes.end(), node) != scene.nodes.end();
    if (shows && !parent && !placed) scene.nodes.push_back(node);
  }
  std::vector<Index>* list = parent ? &document.nodes[*parent].children : nullptr;
  if (list && std::find(list->begin(), list->end(), node) == list->end()) list->push_back(node);
  for (const SkeletonRoot& root : roots) document.nodes[node].children.push_back(root.node);
}

void joinSkins(Asset& asset, const BindPose& bind, const AssetSkeleton& skeleton, Index node, const Affine& world) {
  const auto isJoint = [&](Index n) {
    return std::find(skeleton.jointNode.begin(), skeleton.jointNode.end(), n) != skeleton.jointNode.end();
  };
  for (Index s = 0; s < asset.document.skins.size(); ++s) {
    const SkinBinding binding = readSkinBinding(asset, s);
    if (std::none_of(binding.joints.begin(), binding.joints.end(), isJoint)) continue;
    std::vector<Affine> inverseBinds = binding.inverseBinds;
    inverseBinds.push_back(world.inverse(Eigen::Affine) * bind.skinToWorld[s]);
    std::vector<float> matrices;
    for (const Affine& matrix : inverseBinds) {
      for (int i = 0; i < 16; ++i) matrices.push_back(static_cast<float>(matrix.matrix()(i % 4, i / 4)));
    }
    gltf::Skin& skin = asset.document.skins[s];
    skin.joints.push_back(node);
    skin.inverseBindMatrices = addFloatAccessor(asset, matrices, 16);
    skin.skeleton = node;
  }
}

AssetSkeleton below(AssetSkeleton skeleton, Joint root, Index node) {
  const Affine toRoot = root.rest.toAffine().inverse(Eigen::Affine);
  for (Joint& joint : skeleton.skeleton.joints) {
    if (!joint.parent) joint.rest = decompose(toRoot * joint.rest.toAffine());
    joint.parent = joint.parent ? *joint.parent + 1 : 0;
  }
  skeleton.skeleton.joints.insert(skeleton.skeleton.joints.begin(), std::move(root));
  skeleton.jointNode.insert(skeleton.jointNode.begin(), node);
  return skeleton;
}

// The only root, where it lies on the ground at the origin, as engines expect it.
std::optional<Index> rootOnGround(const Skeleton& skeleton) {
  const std::vector<Joint>& joints = skeleton.joints;
  const auto isRoot = [](const Joint& joint) { return !joint.parent; };
  if (joints.size() < 2 || std::count_if(joints.begin(), joints.end(), isRoot) != 1) return std::nullopt;
  const auto root = static_cast<Index>(std::find_if(joints.begin(), joints.end(), isRoot) - joints.begin());
  Box box;
  const std::vector<Vec3> positions = restPositions(skeleton);
  for (const Vec3& position : positions) box.add(position);
  const double most = kOnGround * box.diagonal();
  if (positions[root].norm() > most || positions[root].y() - box.min.y() > most) return std::nullopt;
  return root;
}

}  // namespace

std::optional<Index> findRootJoint(const Asset& asset, const AssetSkeleton& skeleton) {
  const std::optional<Index> root = rootOnGround(skeleton.skeleton);
  if (!root || !hasRig(asset)) return root;
  const SkinWeights weights = readWeights(asset, collectGeometry(asset), skeleton);
  for (Index v = 0; v < weights.vertexCount(); ++v) {
    const std::span<const float> strongest = weights.weightsOf(v);
    const float next = strongest.size() > 1 ? strongest[1] : 0;
    if (weights.jointsOf(v)[0] == *root && strongest[0] > next) return std::nullopt;
  }
  return root;
}

AssetSkeleton addRootJoint(Asset& asset, const std::string& name) {
  const AssetSkeleton skeleton = animatedSkeleton(asset);
  const SceneGraph graph = readSceneGraph(asset.document);
  const BindPose bind = readBindPose(asset, graph);
  const AccessorSweep unused(asset);
  std::vector<SkeletonRoot> roots = rootsOf(skeleton);
  const std::optional<Index> parent = commonParent(graph, roots);
  const Affine frame = parent ? graph.world[*parent] : Affine::Identity();
  const Affine local = localOfRoot(asset, parent, frame), world = frame * local;
  const Affine intoRoot = local.inverse(Eigen::Affine);
  const std::vector<bool> animated = animatedNodes(asset.document);
  for (SkeletonRoot& root : roots) {
    root.change = intoRoot * frameBetween(asset, graph, animated, parent, root.node);
    Transform parts;
    if (animated[root.node] && !root.change.matrix().isIdentity(0) && !keepsForm(root.change, parts)) {
      refuse(asset, root.node, "is animated in a stretched frame, so that it cannot hang on another joint");
    }
  }

  UniqueNames names;
  for (const gltf::Node& node : asset.document.nodes) names.add(node.name);
  for (Index j = 0; j < skeleton.jointNode.size(); ++j) {
    const std::string& known = skeleton.skeleton.joints[j].name;
    if (known != asset.document.nodes[skeleton.jointNode[j]].name) names.add(known);
  }
  Joint joint;
  joint.name = names.add(name);
  joint.rest = decompose(world);
  gltf::Node made;
  made.name = joint.name;
  setNodeTransform(made, local, false);
  const Joint& first = skeleton.skeleton.joints[roots.front().joint];
  if (skeleton.skeleton.boneShape == BoneShape::kSphere && first.radius > 0) {
    joint.radius = first.radius;
    storeRadius(made, joint.radius);
  }
  const Index node = addElement(asset.document.nodes, std::move(made));
  hangRoots(asset.document, graph, roots, parent, node);
  for (const SkeletonRoot& root : roots) {
    if (root.change.matrix().isIdentity(0)) continue;
    setNodeTransform(asset.document.nodes[root.node], root.change * graph.local[root.node], !animated[root.node]);
    changeChannels(asset, root);
  }
  joinSkins(asset, bind, skeleton, node, world);
  unused.sweep(asset);
  if (const std::optional<Index> own = rootOnGround(skeleton.skeleton)) {
    asset.warnings.add("second-root", "the skeleton's own root carries vertices, so it gets another one above it",
                       skeleton.skeleton.joints[*own].name);
  }
  return below(skeleton, std::move(joint), node);
}

}  // namespace limber
