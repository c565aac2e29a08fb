// People with a rig and a little surface, made in code.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include <nlohmann/json.hpp>

#include "limber/character/anatomy/testing/bodies.h"
#include "limber/document/clip/motion_io.h"
#include "limber/document/gltf/accessor.h"
#include "limber/document/gltf/extensions.h"
#include "limber/document/scene/scene_graph.h"

namespace limber::testing {

// 1.7 m tall, named as by Mixamo, arms hanging by 45 degrees.
inline Skeleton mixamoPerson() {
  return inRestPose(personWith(NameHabit::kMixamo).skeleton,
                    {{"mixamorig:LeftArm", turn(Vec3::UnitZ(), -45)}, {"mixamorig:RightArm", turn(Vec3::UnitZ(), 45)}});
}

// The motion's skeleton and clips with a mesh: at each joint a triangle that follows it alone, a centimetre large.
inline Asset avatarOf(const Motion& motion) {
  Asset asset = motionAsset(motion);
  asset.name = "hero.glb";
  std::vector<float> positions, weights;
  std::vector<std::uint8_t> joints;
  const std::vector<Vec3> points = restPositions(motion.skeleton);
  for (Index j = 0; j < motion.skeleton.jointCount(); ++j) {
    for (const Vec3& corner : {Vec3(0, 0, 0), Vec3(0.01, 0, 0), Vec3(0, 0.01, 0)}) {
      for (int i = 0; i < 3; ++i) positions.push_back(static_cast<float>((points[j] + corner)[i]));
      joints.insert(joints.end(), {static_cast<std::uint8_t>(j), 0, 0, 0});
      weights.insert(weights.end(), {1, 0, 0, 0});
    }
  }
  const auto count = static_cast<Index>(positions.size() / 3);
  gltf::Primitive primitive;
  primitive.attributes.set("POSITION", addFloatAccessor(asset, positions, 3, kVertexTarget, true));
  primitive.attributes.set("JOINTS_0",
                           addAccessor(asset, {count, 4, ComponentType::kU8, false}, joints, kVertexTarget));
  primitive.attributes.set("WEIGHTS_0", addFloatAccessor(asset, weights, 4, kVertexTarget));
  gltf::Mesh mesh;
  mesh.primitives.push_back(std::move(primitive));
  gltf::Node node;
  node.name = "body";
  node.mesh = addElement(asset.document.meshes, std::move(mesh));
  node.skin = 0;
  const Index body = addElement(asset.document.nodes, std::move(node));
  asset.document.scenes[0].nodes.push_back(body);
  checkAsset(asset);
  return asset;
}

inline Asset avatarOf(const Skeleton& skeleton) {
  Motion motion;
  motion.name = "hero";
  motion.skeleton = skeleton;
  return avatarOf(motion);
}

// Gives a mesh blend shapes of these names, which move nothing.
inline void nameShapes(Asset& asset, Index mesh, const std::vector<std::string>& names) {
  gltf::Primitive& primitive = asset.document.meshes[mesh].primitives[0];
  const Index position = *primitive.attributes.find("POSITION");
  const std::vector<float> zeros(3 * accessorInfo(asset, position).count, 0.0f);
  for (std::size_t s = 0; s < names.size(); ++s) {
    primitive.targets.emplace_back().set("POSITION", addFloatAccessor(asset, zeros, 3, kVertexTarget, true));
  }
  asset.document.meshes[mesh].extras.change()["targetNames"] = names;
}

// The world position of that bone's node, as a VRM's humanoid names the bone.
inline Vec3 bonePosition(const Asset& asset, const std::string& bone) {
  const Json& bones = extensionOf(asset.document, "VRMC_vrm")->at("humanoid").at("humanBones");
  return readSceneGraph(asset.document).world[bones.at(bone).at("node").get<Index>()].translation();
}

}  // namespace limber::testing
