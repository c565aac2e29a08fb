#include "limber/document/clip/moving_parents.h"

#include <algorithm>
#include <numeric>
#include <utility>
#include <vector>

#include "limber/document/clip/clip_io.h"
#include "limber/document/gltf/accessor_sweep.h"
#include "limber/document/gltf/compact_buffers.h"
#include "limber/document/gltf/extensions.h"
#include "limber/document/scene/node_edit.h"
#include "limber/document/scene/scene_graph.h"
#include "limber/document/unique_names.h"

namespace limber {

namespace {

constexpr const char* kLightName = "KHR_lights_punctual";

bool isTransform(std::string_view path) {
  return path == "translation" || path == "rotation" || path == "scale";
}

// Settles the nodes above the roots of one skeleton.
class ParentSettler {
 public:
  ParentSettler(Asset& asset, const AssetSkeleton& skeleton)
      : asset_(asset), graph_(readSceneGraph(asset.document)), above_(graph_.nodeCount(), false) {
    for (Index j = 0; j < skeleton.jointNode.size(); ++j) {
      if (skeleton.skeleton.joints[j].parent) continue;
      for (std::optional<Index> n = graph_.parent[skeleton.jointNode[j]]; n && !above_[*n]; n = graph_.parent[*n]) {
        above_[*n] = true;
      }
    }
  }

  void settle(std::span<const Index> animations) {
    checkKeySharing(asset_, animations);
    std::vector<Index> moving;
    std::copy_if(animations.begin(), animations.end(), std::back_inserter(moving),
                 [&](Index a) { return findMoving(asset_.document.animations[a]); });
    if (moving.empty()) return;
    const AccessorSweep accessors(asset_);
    const BufferViewSweep views(asset_);
    const AssetSkeleton carried = carriedNodes();
    Warnings warnings;  // of keys that are none by whoever reads the skeleton's own clips
    const std::vector<Clip> clips = readClips(asset_, carried, moving, warnings);
    for (const Warning& warning : warnings.items()) {
      if (warning.kind != "moving-parents") continue;
      asset_.warnings.add(warning.kind, warning.message, warning.where, warning.count);
    }
    std::vector<bool> isReplaced = moves_;
    for (const Index node : carried.jointNode) isReplaced[node] = true;
    for (const Index a : moving) {
      removeChannels(asset_.document.animations[a],
                     [&](Index node, std::string_view path) { return isReplaced[node] && isTransform(path); });
    }
    addClips(asset_, carried, clips);
    moveLastAnimations(asset_.document, moving);
    accessors.sweep(asset_);
    views.sweep(asset_);
  }

 private:
  bool findMoving(const gltf::Animation& animation) {
    moves_.resize(graph_.nodeCount(), false);
    bool any = false;
    for (const gltf::AnimationChannel& channel : animation.channels) {
      const ChannelTarget target = channelTarget(channel);
      if (!target.node || !above_[*target.node] || !isTransform(target.path)) continue;
      if (repeatsItsNode(asset_, animation, channel)) continue;
      moves_[*target.node] = any = true;
    }
    return any;
  }

  // What hangs on the moving nodes, each as a root joint of its own.
  AssetSkeleton carriedNodes() {
    AssetSkeleton carried;
    UniqueNames names;
    std::vector<bool> isMoved(moves_);
    for (const Index n : graph_.allNodes) {
      const gltf::Node& node = asset_.document.nodes[n];
      const std::optional<Index> parent = graph_.parent[n];
      const bool hangs = parent && isMoved[*parent];
      if (above_[n]) {
        isMoved[n] = isMoved[n] || hangs;
        const bool isSeen = (node.mesh && !node.skin) || node.camera || extensionOf(node, kLightName) != nullptr;
        if (isMoved[n] && isSeen) {
          asset_.warnings.add("still-parents",
                              "meshes, cameras and lights on nodes above root joints stand still: the joints move "
                              "alone",
                              node.name);
        }
        continue;
      }
      isMoved[n] = false;  // those below have it from this one
      if (!hangs || (node.skin && node.children.empty())) continue;
      Joint joint;
      joint.name = names.add(node.name.empty() ? std::to_string(n) : node.name);
      joint.rest = decompose(graph_.world[n]);
      carried.skeleton.joints.push_back(std::move(joint));
      carried.jointNode.push_back(n);
    }
    return carried;
  }

  Asset& asset_;
  SceneGraph graph_;
  std::vector<bool> above_, moves_;  // #nodes: above a root joint; of these, by an animation
};

}  // namespace

void settleMovingParents(Asset& asset, const AssetSkeleton& skeleton, std::span<const Index> animations) {
  ParentSettler(asset, skeleton).settle(animations);
}

void settleMovingParents(Asset& asset, const AssetSkeleton& skeleton) {
  std::vector<Index> all(asset.document.animations.size());
  std::iota(all.begin(), all.end(), Index{0});
  settleMovingParents(asset, skeleton, all);
}

}  // namespace limber
