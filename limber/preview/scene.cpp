#include "limber/preview/scene.h"

#include <algorithm>

#include <nlohmann/json.hpp>

#include "limber/asset/accessor.h"
#include "limber/asset/geometry.h"
#include "limber/asset/pose_io.h"
#include "limber/asset/scene_graph.h"
#include "limber/pipeline/pose_asset.h"
#include "limber/preview/palette.h"
#include "limber/preview/scene_textures.h"

namespace limber {

namespace {

// Linear RGB of a primitive's material: its base colour factor; clay where there is none, and for the texture where
// that is not drawn.
Vec3f materialColor(const Asset& asset, const Json& primitive, bool isDrawn) {
  const Vec3f clay = linearFromSrgb(190, 181, 172);
  const auto number = indexMember(primitive, "material");
  if (!number) return clay;
  const Json& material = elements(asset, "materials")[*number];
  const Json* metallicRoughness = member(material, "pbrMetallicRoughness");
  const Json* factor = metallicRoughness ? member(*metallicRoughness, "baseColorFactor") : nullptr;
  if (isDrawn && !factor) return Vec3f::Ones();
  const bool textured = !isDrawn && metallicRoughness && member(*metallicRoughness, "baseColorTexture");
  if (!factor || !factor->is_array() || factor->size() < 3) return textured ? clay : Vec3f(Vec3f::Constant(0.8f));
  Vec3f color;
  for (std::size_t i = 0; i < 3; ++i) {
    const Json& channel = (*factor)[i];
    color[static_cast<Eigen::Index>(i)] = channel.is_number() ? std::clamp(channel.get<float>(), 0.0f, 1.0f) : 1.0f;
  }
  return textured ? Vec3f(color.cwiseProduct(clay)) : color;
}

void colorInstance(const Asset& asset, const PrimitiveInstance& instance, bool isTextured, std::vector<Vec3f>& colors) {
  const Json& primitive = elements(asset, "meshes")[instance.mesh].at("primitives")[instance.primitive];
  const Vec3f base = materialColor(asset, primitive, isTextured);
  std::fill_n(colors.begin() + instance.firstVertex, instance.vertexCount, base);
  const auto accessor = indexMember(primitive.at("attributes"), "COLOR_0");
  if (!accessor) return;
  const Index components = accessorInfo(asset, *accessor).components;
  const std::vector<float> values = readFloats(asset, *accessor);
  if (components < 3 || values.size() != std::size_t{components} * instance.vertexCount) return;
  for (Index v = 0; v < instance.vertexCount; ++v) {
    for (Index channel = 0; channel < 3; ++channel) {
      colors[instance.firstVertex + v][channel] *= std::clamp(values[v * components + channel], 0.0f, 1.0f);
    }
  }
}

}  // namespace

Scene makeScene(const Asset& asset) {
  Scene scene;
  Geometry geometry;
  if (hasRig(asset)) {
    const AssetSkeleton rig = readSkeleton(asset);
    const Pose pose = readNodePose(asset, rig);
    geometry = posedGeometry(asset, rig, pose).geometry;
    Skeleton posed = rig.skeleton;
    for (Index j = 0; j < posed.jointCount(); ++j) posed.joints[j].rest = pose.locals[j];
    posed.boneShape = BoneShape::kSegment;
    const std::vector<Affine> globals = restGlobals(posed);
    for (Index j = 0; j < posed.jointCount(); ++j) {
      const Joint& joint = posed.joints[j];
      scene.joints.push_back({joint.name, globals[j].translation(), joint.parent, joint.radius});
    }
    scene.bones = bonesOf(posed);
    scene.weights = readWeights(asset, geometry, rig);
  } else {
    geometry = collectGeometry(asset);
  }
  scene.colors.resize(geometry.positions.size());
  scene.triangles = std::move(geometry.triangles);
  const std::vector<bool> isTextured = addTextures(asset, geometry, scene);
  for (std::size_t i = 0; i < geometry.instances.size(); ++i) {
    colorInstance(asset, geometry.instances[i], isTextured[i], scene.colors);
  }
  scene.positions = std::move(geometry.positions);
  return scene;
}

}  // namespace limber
