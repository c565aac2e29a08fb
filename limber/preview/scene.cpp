#include "limber/preview/scene.h"

#include <algorithm>

#include "limber/document/gltf/accessor.h"
#include "limber/document/rig/pose_io.h"
#include "limber/document/rig/weight_attributes.h"
#include "limber/preview/image/palette.h"
#include "limber/preview/scene_materials.h"
#include "limber/preview/shapes.h"
#include "limber/skeleton/clip/clip.h"

namespace limber {

namespace {

// Linear RGB of a primitive's material: its base colour factor; clay where there is none, and for the texture where
// that is not drawn.
Vec3f materialColor(const gltf::Document& document, const gltf::Primitive& primitive, bool isDrawn) {
  const Vec3f clay = linearFromSrgb(190, 181, 172);
  if (!primitive.material) return clay;
  const std::optional<gltf::MetallicRoughness>& surface = document.materials[*primitive.material].pbrMetallicRoughness;
  const bool isSaid = surface && surface->baseColorFactor;
  if (isDrawn && !isSaid) return Vec3f::Ones();
  const bool textured = !isDrawn && surface && surface->baseColorTexture;
  if (!isSaid) return textured ? clay : Vec3f(Vec3f::Constant(0.8f));
  const Vec3f color = surface->baseColorFactor->head<3>().cast<float>().cwiseMax(0.0f).cwiseMin(1.0f);
  return textured ? Vec3f(color.cwiseProduct(clay)) : color;
}

void colorInstance(const Asset& asset, const PrimitiveInstance& instance, bool isTextured, std::vector<Vec3f>& colors) {
  const gltf::Primitive& primitive = asset.document.meshes[instance.mesh].primitives[instance.primitive];
  const Vec3f base = materialColor(asset.document, primitive, isTextured);
  std::fill_n(colors.begin() + instance.firstVertex, instance.vertexCount, base);
  const std::optional<Index> accessor = primitive.attributes.find("COLOR_0");
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

// The joints and bones of a skeleton in a pose.
void addSkeleton(const Character& character, const Pose& pose, Scene& scene) {
  Skeleton posed = character.skeleton();
  for (Index j = 0; j < posed.jointCount(); ++j) posed.joints[j].rest = pose.locals[j];
  posed.boneShape = BoneShape::kSegment;
  const std::vector<Affine> globals = restGlobals(posed);
  const Anatomy& anatomy = character.anatomy();
  for (Index j = 0; j < posed.jointCount(); ++j) {
    const Joint& joint = posed.joints[j];
    SceneJoint& shown =
        scene.joints.emplace_back(SceneJoint{joint.name, globals[j].translation(), joint.parent, joint.radius});
    if (!anatomy.partOf[j]) continue;
    shown.kind = anatomy.parts[*anatomy.partOf[j]].kind;
    shown.side = anatomy.parts[*anatomy.partOf[j]].side;
  }
  scene.bones = bonesOf(posed);
}

void addSurface(const Asset& asset, Geometry geometry, Scene& scene) {
  scene.colors.resize(geometry.positions.size());
  scene.triangles = std::move(geometry.triangles);
  const std::vector<bool> isTextured = addMaterials(asset, geometry, scene);
  for (std::size_t i = 0; i < geometry.instances.size(); ++i) {
    const PrimitiveInstance& instance = geometry.instances[i];
    colorInstance(asset, instance, isTextured[i], scene.colors);
    const gltf::Mesh& mesh = asset.document.meshes[instance.mesh];
    reportLostInfluences(mesh.primitives[instance.primitive], mesh.name, scene.warnings);
  }
  scene.positions = std::move(geometry.positions);
}

// A skeleton without a mesh: its bones are what is seen.
Scene boneScene(const Character& character, const Pose& pose) {
  Scene scene;
  addSkeleton(character, pose, scene);
  Box box;
  for (const SceneJoint& joint : scene.joints) box.add(joint.position);
  ShapeMesh shapes;
  for (const Bone& bone : scene.bones) addOctahedralBone(shapes, bone.a, bone.b, jointColor(bone.joint));
  constexpr double kJointRadius = 0.006;     // of the skeleton's diagonal
  constexpr std::size_t kMaxSpheres = 1000;  // more would hide the bones
  const double radius = kJointRadius * (box.diagonal() > 0 ? box.diagonal() : 1);
  const Vec3f dark = linearFromSrgb(96, 104, 118);
  if (scene.joints.size() <= kMaxSpheres) {
    for (const SceneJoint& joint : scene.joints) addSphere(shapes, joint.position, radius, dark);
  }
  scene.positions = std::move(shapes.positions);
  scene.triangles = std::move(shapes.triangles);
  scene.colors = std::move(shapes.colors);
  return scene;
}

}  // namespace

SceneMaker::SceneMaker(const Character& character, const Deformer& deformer) : character_(character) {
  if (character.hasRig()) poser_ = std::make_unique<AssetPoser>(character, character.moving(), deformer);
  if (poser_) boundPositions_ = poser_->posed(restPose(character.skeleton())).geometry.positions;
  if (hasSkeleton()) character.moving();  // throws where it has no joints
}

Scene SceneMaker::at(const Pose& pose) const {
  return at(pose, readShapeWeights(character_.document()));
}

Scene SceneMaker::at(const Pose& pose, const ShapeWeights& shapes) const {
  const Asset& asset = character_.document();
  if (!poser_) throw Error(ErrorCode::kUnsupported, "has no rig to pose", asset.name, "rig it first: limber rig");
  Scene scene;
  Geometry geometry = poser_->posed(pose, shapes).geometry;
  addSkeleton(character_, pose, scene);
  scene.weights = poser_->weights();
  scene.boundPositions = boundPositions_;
  addSurface(asset, std::move(geometry), scene);
  return scene;
}

Scene SceneMaker::still() const {
  const Asset& asset = character_.document();
  if (!hasSkeleton()) return unrigged(readShapeWeights(asset));
  const Pose pose = readNodePose(asset, character_.moving());
  return poser_ ? at(pose) : boneScene(character_, pose);
}

bool SceneMaker::isAtRest() const {
  // Of single precision and inverse binds, seen in files; a pose that is meant moves joints by more.
  constexpr double kRounding = 1e-3;  // of the skeleton's diagonal, and of a unit vector
  if (!hasSkeleton()) return true;
  const AssetSkeleton& moving = character_.moving();
  const std::vector<Affine> rest = restGlobals(moving.skeleton);
  const std::vector<Affine> now = poseGlobals(moving.skeleton, readNodePose(character_.document(), moving));
  Box box;
  for (const Affine& joint : rest) box.add(joint.translation());
  for (std::size_t j = 0; j < rest.size(); ++j) {
    const double moved = (now[j].translation() - rest[j].translation()).norm();
    const double turned = (now[j].linear() - rest[j].linear()).norm();
    if (moved > kRounding * box.diagonal() || turned > kRounding * rest[j].linear().norm()) return false;
  }
  return true;
}

Scene SceneMaker::unrigged(const ShapeWeights& shapes) const {
  Scene scene;
  Geometry geometry = character_.surface();
  moveByShapes(character_.document(), shapes, geometry);
  addSurface(character_.document(), std::move(geometry), scene);
  return scene;
}

double SceneMaker::duration(const Clip& clip) const {
  const Asset& asset = character_.document();
  const std::optional<Index> animation = animationNamed(asset.document, clip.name);
  return std::max(clip.duration(), animation ? shapeDuration(asset, *animation) : 0);
}

Scene SceneMaker::at(const Clip& clip, double seconds) const {
  const Asset& asset = character_.document();
  const ShapeWeights shapes = readShapeWeights(asset, animationNamed(asset.document, clip.name), seconds);
  if (!hasSkeleton()) {
    if (clip.translations.empty() && clip.rotations.empty() && clip.scales.empty()) return unrigged(shapes);
    throw Error(ErrorCode::kUnsupported, "its clips move meshes without a skeleton, which limber does not draw",
                asset.name);
  }
  Pose pose = restPose(character_.skeleton());
  sampleClip(clip, seconds, pose);
  return poser_ ? at(pose, shapes) : boneScene(character_, pose);
}

Scene makeScene(const Character& character) {
  return SceneMaker(character).still();
}

}  // namespace limber
