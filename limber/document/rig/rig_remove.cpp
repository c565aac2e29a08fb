// Takes the rig of a document out and leaves the model standing in its bind pose.
#include <algorithm>
#include <cmath>
#include <map>
#include <string>
#include <string_view>
#include <utility>

#include "limber/document/gltf/accessor_sweep.h"
#include "limber/document/rig/bind_pose.h"
#include "limber/document/rig/rig_io.h"
#include "limber/document/rig/skinned_nodes.h"
#include "limber/document/rig/weight_attributes.h"
#include "limber/document/scene/node_edit.h"

namespace limber {

namespace {

// Relative: placements that differ less are one, since inverse bind matrices are stored in single precision.
constexpr double kSamePosition = 1e-5;

bool near(const Affine& a, const Affine& b) {
  return samePlacement(a, b, kSamePosition);
}

class RigRemover {
 public:
  explicit RigRemover(Asset& asset)
      : asset_(asset), graph_(readSceneGraph(asset.document)), pose_(readBindPose(asset, graph_)) {
    isJoint_.assign(graph_.nodeCount(), false);
    for (const gltf::Skin& skin : asset.document.skins) {
      for (const Index joint : skin.joints) isJoint_[joint] = true;
    }
  }

  void run() {
    std::vector<bool> keep = nodesToKeep();
    giveMeshesBack(keep);
    removeJointChannels();
    placeKeptNodes(keep);
    for (gltf::Node& node : asset_.document.nodes) node.skin.reset();
    removeAttributes();
    asset_.document.skins.clear();
    deleteNodes(asset_, keep);
  }

 private:
  gltf::Node& node(Index n) const { return asset_.document.nodes[n]; }

  // Joints and their descendants go unless they, or nodes below them, contain something that is not the rig's. So do
  // nodes above that contained nothing but joints (an exporter's "Armature", limber's own "limber_rig").
  std::vector<bool> nodesToKeep() const {
    std::vector<bool> onJoint(isJoint_), keep(graph_.nodeCount()), lostChild(graph_.nodeCount());
    for (const Index n : graph_.allNodes) {
      if (graph_.parent[n] && onJoint[*graph_.parent[n]]) onJoint[n] = true;
    }
    for (auto at = graph_.allNodes.rbegin(); at != graph_.allNodes.rend(); ++at) {
      const Index n = *at;
      const bool holds = node(n).mesh || node(n).camera || node(n).extensions.exists();
      const bool ofRig = onJoint[n] || (lostChild[n] && !node(n).extras.exists());
      keep[n] = keep[n] || holds || !ofRig;  // keep[n] may have been set by a child
      if (!graph_.parent[n]) continue;
      if (keep[n]) {
        keep[*graph_.parent[n]] = true;
      } else {
        lostChild[*graph_.parent[n]] = true;
      }
    }
    return keep;
  }

  // A mesh that attachRig moved to a node at the root returns to the node that it came from, so that repeated rigging
  // does not pile up nodes: recognised by the name, where that node has no mesh and has the mesh's transform.
  void giveMeshesBack(std::vector<bool>& keep) {
    std::map<std::string, std::vector<Index>> byName;
    for (Index n = 0; n < graph_.nodeCount(); ++n) byName[node(n).name].push_back(n);
    for (Index n = 0; n < graph_.nodeCount(); ++n) {
      gltf::Node& shown = node(n);
      const std::string& name = shown.name;
      const std::size_t length = name.size() - std::min(name.size(), std::string_view(kSkinnedSuffix).size());
      const bool moved = shown.skin && shown.mesh && !graph_.parent[n] && shown.children.empty() &&
                         !shown.extras.exists() && name.compare(length, std::string::npos, kSkinnedSuffix) == 0;
      if (!moved) continue;
      const auto source = byName.find(name.substr(0, length));
      if (source == byName.end() || source->second.size() != 1) continue;
      const Index home = source->second[0];
      const Affine& transform = pose_.skinToWorld[*shown.skin];
      if (node(home).mesh || !keep[home] || !near(transform, pose_.nodeWorld[home])) continue;
      node(home).mesh = std::exchange(shown.mesh, std::nullopt);
      if (!shown.weights.empty()) node(home).weights = shown.weights;
      retargetMorphChannels(asset_, n, home);
      keep[n] = false;
    }
  }

  // Movements of joints go, and of skinned nodes that nothing hangs on: these moved nothing.
  void removeJointChannels() {
    removeChannels(asset_, [&](Index n, std::string_view path) {
      if (n >= graph_.nodeCount() || path == "weights") return false;
      return isJoint_[n] || (node(n).skin && node(n).children.empty());
    });
  }

  std::vector<bool> animatedNodes() const {
    std::vector<bool> animated(graph_.nodeCount(), false);
    for (const gltf::Animation& animation : asset_.document.animations) {
      for (const gltf::AnimationChannel& channel : animation.channels) {
        if (channel.target.node) animated[*channel.target.node] = true;
      }
    }
    return animated;
  }

  // A node's new world transform: that of the bind pose, or, for a skinned one, that of the mesh in its skin.
  Affine transformOf(Index n) const {
    const gltf::Node& placed = node(n);
    const Affine transform = placed.skin && placed.mesh ? pose_.skinToWorld[*placed.skin] : pose_.nodeWorld[n];
    return near(transform, graph_.world[n]) ? graph_.world[n] : transform;
  }

  void placeKeptNodes(const std::vector<bool>& keep) {
    const std::vector<bool> animated = animatedNodes();
    std::vector<Affine> world = graph_.world;
    for (const Index n : graph_.allNodes) {
      if (!keep[n]) continue;
      const Affine above = graph_.parent[n] ? world[*graph_.parent[n]] : Affine::Identity();
      const Affine stays = above * graph_.local[n];  // its world transform if its own transform is left as it is
      const Affine transform = transformOf(n);
      const Affine local = above.inverse(Eigen::Affine) * transform;
      if (near(transform, stays) || !local.matrix().allFinite()) {
        world[n] = stays;
        continue;
      }
      setNodeTransform(node(n), local, !animated[n]);
      world[n] = above * nodeTransform(node(n));
    }
  }

  void removeAttributes() {
    for (gltf::Mesh& mesh : asset_.document.meshes) {
      for (gltf::Primitive& primitive : mesh.primitives) eraseWeightAttributes(primitive);
    }
  }

  Asset& asset_;
  SceneGraph graph_;
  BindPose pose_;
  std::vector<bool> isJoint_;  // #nodes, of any skin
};

}  // namespace

void removeRig(Asset& asset) {
  if (asset.document.skins.empty()) return;
  const AccessorSweep unused(asset);
  RigRemover(asset).run();
  unused.sweep(asset);
}

}  // namespace limber
