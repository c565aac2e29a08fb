#include "limber/actions/rig/rig_from_animation.h"

#include <algorithm>
#include <utility>

#include <nlohmann/json.hpp>

#include "limber/actions/report_json.h"
#include "limber/core/known_error.h"
#include "limber/document/clip/clip_io.h"
#include "limber/document/gltf/json_text.h"
#include "limber/document/rig/pose_io.h"
#include "limber/document/rig/rig_io.h"
#include "limber/document/scene/node_edit.h"
#include "limber/document/scene/scene_graph.h"

namespace limber {

namespace {

// Nodes that show a mesh, and those above: what moves them would move the mesh a second time.
std::vector<bool> nodesOfMeshes(const Asset& asset) {
  const SceneGraph graph = readSceneGraph(asset.document);
  std::vector<bool> carries(graph.nodeCount(), false);
  for (auto n = graph.allNodes.rbegin(); n != graph.allNodes.rend(); ++n) {
    if (asset.document.nodes[*n].mesh) carries[*n] = true;
    if (carries[*n] && graph.parent[*n]) carries[*graph.parent[*n]] = true;
  }
  return carries;
}

// The meshes alone as they are bound, at the scene's root; returns them.
Geometry bareGeometry(Asset& asset) {
  const std::vector<bool> carries = nodesOfMeshes(asset);
  removeChannels(asset, [&](Index node, std::string_view) { return node < carries.size() && carries[node]; });
  const Character bound(asset);
  freezeGeometry(asset, bound.surface(), bound.surface().positions, readNormals(asset, bound.surface()));
  return collectGeometry(asset);
}

// The clips over the joints as the document orders them.
void nameJointsBy(const std::vector<Index>& jointNodes, const AssetSkeleton& skeleton, std::vector<Clip>& clips) {
  std::vector<Index> jointOf;
  for (const Index node : jointNodes) {
    const auto found = std::find(skeleton.jointNode.begin(), skeleton.jointNode.end(), node);
    jointOf.push_back(static_cast<Index>(found - skeleton.jointNode.begin()));
  }
  for (Clip& clip : clips) {
    for (auto& track : clip.translations) track.joint = jointOf[track.joint];
    for (auto& track : clip.rotations) track.joint = jointOf[track.joint];
  }
}

void attach(Asset& asset, const VertexAnimation& animation, const BoneSkeleton& bones, const BoneMotions& motions) {
  const Geometry geometry = bareGeometry(asset);
  if (geometry.positions.size() != animation.pointOf.size()) {
    throw Error(ErrorCode::kBadArgument, "the animation is not that of this model");
  }
  const std::vector<Index> nodes =
      attachRig(asset, geometry, bones.skeleton, expandWeights(bones.weights, animation.pointOf));
  std::vector<Clip> clips;
  for (const FrameSpan& span : animation.clips) {
    clips.push_back(clipOfBones(bones, motions, span));
  }
  const AssetSkeleton skeleton = readSkeleton(asset);
  nameJointsBy(nodes, skeleton, clips);
  addClips(asset, skeleton, clips);
}

}  // namespace

AnimationRigReport rigFromAnimation(Asset& asset, VertexAnimation animation, const DecompositionOptions& options,
                                    Progress& progress) {
  try {
    AnimationRigReport report;
    report.sourceVertices = static_cast<Index>(animation.pointOf.size());
    report.points = animation.sequence.pointCount();
    report.frames = animation.sequence.frameCount();
    report.clips = static_cast<Index>(animation.clips.size());
    report.maxInfluences = options.maxInfluences;
    progress.stage("find bones");
    const std::vector<Vec3f> rest = animation.sequence.rest;
    const Decomposition decomposition = decomposeSkin(std::move(animation.sequence), options, progress);
    progress.stage("find joints");
    const BoneSkeleton bones = skeletonOfBones(rest, decomposition);
    progress.stage("write rig");
    Asset result = asset.clone();
    attach(result, animation, bones, decomposition.motions);
    checkAsset(result);
    report.joints = bones.skeleton.jointCount();
    report.error = decomposition.error;
    report.warnings = result.warnings;
    progress.finish();
    asset = std::move(result);
    report.stages = progress.stages();
    return report;
  } catch (const Error& error) {
    throwWithin(error, asset.name);
  }
}

}  // namespace limber
