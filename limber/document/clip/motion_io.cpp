#include "limber/document/clip/motion_io.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "limber/core/file/file_view.h"
#include "limber/core/known_error.h"
#include "limber/core/text/names.h"
#include "limber/document/clip/clip_io.h"
#include "limber/document/clip/clip_name.h"
#include "limber/document/gltf/accessor.h"
#include "limber/document/scene/humanoid_nodes.h"
#include "limber/document/scene/node_edit.h"
#include "limber/document/scene/scene_graph.h"
#include "limber/document/unique_names.h"

namespace limber {

namespace {

std::string stemOf(std::string_view name) {
  return std::filesystem::path(std::string(name)).stem().string();
}

// Shows nothing itself.
bool isBare(const gltf::Node& node) {
  return !node.mesh && !node.camera && !node.extensions.exists();
}

// Animated nodes, those between, and bare ones below: the ends of bones. Of a skeleton that nothing moves all bare
// ones.
std::vector<bool> movingTree(const Asset& asset, const SceneGraph& graph) {
  const std::vector<bool> animated = animatedNodes(asset.document);
  const bool all = isSkeletonAlone(asset) && std::find(animated.begin(), animated.end(), true) == animated.end();
  std::vector<bool> below(animated), inside(animated), wanted(animated);
  for (auto n = graph.order.rbegin(); n != graph.order.rend(); ++n) {
    if (graph.parent[*n] && below[*n]) below[*graph.parent[*n]] = true;
  }
  for (const Index n : graph.order) {
    const bool bare = isBare(asset.document.nodes[n]);
    inside[n] = animated[n] || (all && bare) || (graph.parent[n] && inside[*graph.parent[n]] && (bare || below[n]));
    wanted[n] = inside[n] && graph.shown[n];
  }
  return wanted;
}

// The skeleton of a motion for VRMs: its bones, under their names whatever the nodes are called, and nodes between.
AssetSkeleton vrmAnimationSkeleton(const gltf::Document& document, const std::vector<HumanoidNode>& bones) {
  const SceneGraph graph = readSceneGraph(document);
  std::vector<bool> below(graph.nodeCount()), inside(graph.nodeCount());
  std::vector<std::string_view> boneOfNode(graph.nodeCount());
  UniqueNames names;
  for (const HumanoidNode& bone : bones) {
    boneOfNode[bone.node] = bone.bone;
    names.add(std::string(bone.bone));
  }
  for (auto n = graph.allNodes.rbegin(); n != graph.allNodes.rend(); ++n) {
    if (graph.parent[*n] && (below[*n] || !boneOfNode[*n].empty())) below[*graph.parent[*n]] = true;
  }
  AssetSkeleton result;
  std::vector<std::optional<Index>> jointOfNode(graph.nodeCount());
  for (const Index n : graph.allNodes) {
    const std::optional<Index> parent = graph.parent[n];
    inside[n] = !boneOfNode[n].empty() || (parent && inside[*parent] && below[n]);
    if (!inside[n]) continue;
    Joint joint;
    joint.name = boneOfNode[n].empty() ? names.add(document.nodes[n].name) : std::string(boneOfNode[n]);
    joint.declaredBone = boneOfNode[n];
    if (parent) joint.parent = jointOfNode[*parent];
    joint.rest = decompose(joint.parent ? graph.local[n] : graph.world[n]);
    jointOfNode[n] = result.skeleton.jointCount();
    result.jointNode.push_back(n);
    result.skeleton.joints.push_back(std::move(joint));
  }
  return result;
}

Vec3 rounded(const Vec3& v) {
  return {shortDouble(v.x()), shortDouble(v.y()), shortDouble(v.z())};
}

gltf::Node nodeOf(const Joint& joint) {
  gltf::Node node;
  node.name = joint.name;
  node.translation = rounded(joint.rest.translation);
  const Quat& q = joint.rest.rotation;
  if (q.coeffs() != Quat::Identity().coeffs()) {
    node.rotation = {shortDouble(q.x()), shortDouble(q.y()), shortDouble(q.z()), shortDouble(q.w())};
  }
  if (joint.rest.scale != Vec3::Ones()) node.scale = rounded(joint.rest.scale);
  return node;
}

// The nodes of the joints, and one above several roots. Returns the root.
Index addJointNodes(std::vector<gltf::Node>& nodes, const Motion& motion) {
  std::vector<Index> roots;
  UniqueNames names;
  for (Index j = 0; j < motion.skeleton.jointCount(); ++j) {
    const Joint& joint = motion.skeleton.joints[j];
    names.add(joint.name);
    nodes.push_back(nodeOf(joint));
    if (joint.parent) {
      nodes[*joint.parent].children.push_back(j);
    } else {
      roots.push_back(j);
    }
  }
  if (roots.size() == 1) return roots.front();
  gltf::Node above;
  above.name = names.add(motion.name.empty() ? "motion" : motion.name);
  above.children = std::move(roots);
  return addElement(nodes, std::move(above));
}

}  // namespace

Clip findClip(const Asset& asset, std::string_view name) {
  Warnings ignored;  // those of the whole motion, which is not asked for
  const bool hasClips = !asset.document.animations.empty();
  std::vector<Clip> clips = readClips(asset, hasClips ? movingSkeleton(asset) : animatedSkeleton(asset), ignored);
  if (name.empty()) return clips.empty() ? Clip() : std::move(clips.front());
  std::vector<std::string> names;
  for (const Clip& clip : clips) names.push_back(clip.name);
  return std::move(clips[clipNamed(names, name, asset.name)]);
}

bool isSkeletonAlone(const Asset& asset) {
  const gltf::Document& document = asset.document;
  if (!document.meshes.empty()) return false;
  return !document.skins.empty() || !document.animations.empty() || document.nodes.size() > 1;
}

bool isMovedBySkin(const Asset& asset) {
  return !asset.document.skins.empty() && humanoidNodes(asset.document, kVrmAnimationName).empty();
}

AssetSkeleton movingSkeleton(const Asset& asset) {
  if (isMovedBySkin(asset)) return readSkeleton(asset);
  const std::vector<HumanoidNode> bones = humanoidNodes(asset.document, kVrmAnimationName);
  if (!bones.empty()) return vrmAnimationSkeleton(asset.document, bones);
  const SceneGraph graph = readSceneGraph(asset.document);
  const std::vector<bool> wanted = movingTree(asset, graph);
  const std::vector<std::string_view> declared = declaredBoneOfNode(asset.document);
  AssetSkeleton result;
  UniqueNames names;
  std::vector<std::optional<Index>> jointOfNode(graph.nodeCount());
  for (const Index n : graph.order) {
    if (!wanted[n]) continue;
    Joint joint;
    const std::string& name = asset.document.nodes[n].name;
    joint.name = names.add(name.empty() ? "joint_" + std::to_string(n) : name);
    if (graph.parent[n]) joint.parent = jointOfNode[*graph.parent[n]];
    joint.rest = decompose(joint.parent ? graph.local[n] : graph.world[n]);
    joint.declaredBone = declared[n];
    jointOfNode[n] = result.skeleton.jointCount();
    result.jointNode.push_back(n);
    result.skeleton.joints.push_back(std::move(joint));
  }
  return result;
}

AssetSkeleton animatedSkeleton(const Asset& asset) {
  AssetSkeleton skeleton = movingSkeleton(asset);
  if (skeleton.jointNode.empty()) {
    throw KnownError(ErrorKind::kNoMotion,
                     {ErrorCode::kBadData, "has no joints: neither a skeleton nor nodes that move", asset.name},
                     {{"name", asset.name}});
  }
  return skeleton;
}

Motion motionOf(const Asset& asset) {
  return motionOf(asset, animatedSkeleton(asset));
}

Motion motionOf(const Asset& asset, const AssetSkeleton& skeleton) {
  Motion motion;
  motion.name = stemOf(asset.name);
  motion.skeleton = skeleton.skeleton;
  motion.warnings = asset.warnings;
  motion.clips = readClips(asset, skeleton, motion.warnings);
  for (const Clip& clip : motion.clips) {
    const std::optional<double> rate = measuredFrameRate(clip);
    if (!rate) continue;
    motion.framesPerSecond = *rate;
    break;
  }
  return motion;
}

namespace {

// A motion alone is of joints.
Motion motionAlone(const Asset& asset) {
  Motion motion = motionOf(asset);
  for (Index a = 0; a < asset.document.animations.size(); ++a) {
    const gltf::Animation& animation = asset.document.animations[a];
    const bool movesShapes =
        std::any_of(animation.channels.begin(), animation.channels.end(),
                    [](const gltf::AnimationChannel& channel) { return channelTarget(channel).path == "weights"; });
    if (movesShapes)
      motion.warnings.add("motion-shapes", "blend shapes that a motion moves are left out", animation.name);
  }
  return motion;
}

}  // namespace

Motion readMotion(ByteSpan bytes, std::string_view name, const MotionOptions& options, const Resolver& resolver) {
  if (looksLikeBvh(bytes)) return readBvh(bytes, name, options.bvh);
  if (looksLikeNpz(bytes)) return readSmplMotion(bytes, name, options.smpl);
  return motionAlone(readAsset(bytes, name, resolver));
}

Motion readMotion(const std::filesystem::path& path, const MotionOptions& options) {
  if (lowerExtension(path) == ".bvh") return readBvh(path, options.bvh);  // in pieces
  const FileView file(path);
  if (path == "-") return readMotion(file.bytes(), "standard input", options);
  return readMotion(file.bytes(), path.filename().string(), options, folderResolver(path.parent_path()));
}

Asset motionAsset(const Motion& motion) {
  checkMotion(motion);
  if (motion.skeleton.joints.empty()) throw Error(ErrorCode::kBadArgument, "the motion has no joint");
  Asset asset;
  asset.name = motion.name;
  asset.warnings = motion.warnings;
  gltf::Document& document = asset.document;
  document.about.generator = "limber";
  const Index root = addJointNodes(document.nodes, motion);
  gltf::Scene scene;
  scene.nodes = {root};
  document.scene = addElement(document.scenes, std::move(scene));

  AssetSkeleton skeleton;
  skeleton.skeleton = motion.skeleton;
  std::vector<float> binds;
  const std::vector<Affine> inverseBinds = inverseBindOf(motion.skeleton);
  for (Index j = 0; j < motion.skeleton.jointCount(); ++j) {
    skeleton.jointNode.push_back(j);
    for (int i = 0; i < 16; ++i) binds.push_back(static_cast<float>(inverseBinds[j](i % 4, i / 4)));
  }
  gltf::Skin skin;
  skin.name = motion.name;
  skin.inverseBindMatrices = addFloatAccessor(asset, binds, 16);
  skin.skeleton = root;
  skin.joints = skeleton.jointNode;
  document.skins.push_back(std::move(skin));
  addClips(asset, skeleton, motion.clips);
  return asset;
}

}  // namespace limber
