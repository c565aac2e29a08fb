#include "limber/actions/export/engine_target.h"

#include <algorithm>
#include <map>
#include <set>

#include <gtest/gtest.h>

#include "limber/actions/export/bone_axes.h"
#include "limber/actions/export/testing/gltf_player.h"
#include "limber/actions/export/testing/target_people.h"
#include "limber/character/anatomy/names/humanoid_joints.h"
#include "limber/character/anatomy/testing/bodies.h"
#include "limber/document/clip/motion_io.h"
#include "limber/document/gltf/extensions.h"
#include "limber/document/rig/rig_io.h"
#include "limber/document/scene/node_edit.h"
#include "limber/document/scene/scene_graph.h"
#include "limber/document/testing/scene_builder.h"
#include "limber/document/write.h"

namespace limber {
namespace {

using testing::largestMove;
using testing::SceneBuilder;

constexpr double kUnseen = 1e-6;  // of the size

// Two joints below a node that turns and scales them, one with a rigid mesh on it, and a clip with keys of every kind.
Asset movingArm(bool isUneven) {
  SceneBuilder builder;
  const Index mesh = builder.addTetrahedron(), rigid = builder.addTetrahedron(Vec3f(0, 0, 1), 0.5f);
  builder.addNode({{"name", "arm"}, {"mesh", mesh}, {"skin", 0}});
  builder.addNode(
      {{"name", "Armature"}, {"children", {2}}, {"scale", {100, 100, 100}}, {"rotation", {0.6, 0, 0, 0.8}}});
  builder.addNode({{"name", "upper"}, {"children", {3}}, {"translation", {0.01, 0.005, 0}}});
  builder.addNode(
      {{"name", "lower"}, {"children", {4}}, {"translation", {0, 0.01, 0}}, {"rotation", {0, 0, 0.6, 0.8}}});
  builder.addNode({{"name", "sword"}, {"mesh", rigid}, {"translation", {0.001, 0.002, 0}}});
  builder.bind(mesh, {0, 1, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 1, 0, 0, 0},
               {1, 0, 0, 0, 1, 0, 0, 0, 0.5f, 0.5f, 0, 0, 0.75f, 0.25f, 0, 0});
  builder.addSkin({2, 3}, {testing::translation(0.1, -0.4, 0.2), testing::translation(0, -0.3, 0.1)});
  builder.addScene({0, 1});
  Asset& asset = builder.asset();
  gltf::Animation& clip = asset.document.animations.emplace_back();
  const Index times = addFloatAccessor(asset, std::vector<float>{0, 0.5f, 2}, 1, 0, true);
  const auto channel = [&](Index node, const char* path, const std::vector<float>& values, Index size,
                           Interpolation interpolation) {
    const Index output = addFloatAccessor(asset, values, size);
    clip.samplers.push_back({{}, times, output, interpolation});
    clip.channels.push_back({{}, static_cast<Index>(clip.samplers.size() - 1), {{}, node, path}});
  };
  channel(2, "rotation", {0, 0, 0, 1, 0, 0.6f, 0, 0.8f, 0.6f, 0, 0, 0.8f}, 4, Interpolation::kLinear);
  channel(3, "rotation", {0, 0, 0, 0, 0, 0, 0.6f, 0.8f, 0.3f, 0.1f, 0,     0.2f, 0.3f, 0.1f, 0, 0.2f, 0, 0,
                          0, 1, 1, 0, 0, 0, 0,    1,    0,    0,    -0.6f, 0,    0,    0.8f, 0, 0,    0, 0},
          4, Interpolation::kCubic);
  channel(3, "translation", {0, 0, 0, 0, 0.01f, 0,     0.02f, 0, 0,     0.01f, 0, 0, 0.01f, 0.02f,
                             0, 0, 0, 0, 0,     0.01f, 0,     0, 0.01f, 0.01f, 0, 0, 0},
          3, Interpolation::kCubic);
  const float third = isUneven ? 1.5f : 2;
  channel(3, "scale", {1, 1, 1, 2, 2, third, 1, 1, 1}, 3, Interpolation::kLinear);
  // Both joints by one sampler.
  clip.channels.push_back({{}, 0, {{}, 4, "rotation"}});
  return builder.build();
}

TEST(ToTarget, NamesBonesAsTheFileDeclaresThemWhicheverWayTheyFace) {
  Motion motion;
  motion.skeleton = testing::turnedAsAWhole(testing::declaredPerson(), Quat(0, 0, 1, 0));
  Asset asset = motionAsset(motion);
  asset.document.nodes.front().mesh = addElement(asset.document.meshes, {});
  asset.document.nodes.front().skin = 0;
  Json bones = Json::array();
  for (Index j = 0; j < motion.skeleton.jointCount(); ++j) {
    bones.push_back({{"bone", motion.skeleton.joints[j].declaredBone}, {"node", j}});
  }
  changeExtension(asset.document, "VRM") = {{"humanoid", {{"humanBones", bones}}}};
  toTarget(asset, findTarget("vrm"));
  for (Index j = 0; j < motion.skeleton.jointCount(); ++j) {
    EXPECT_EQ(asset.document.nodes[j].name, motion.skeleton.joints[j].declaredBone);
  }
}

TEST(ToTarget, LeavesWhatIsSeenAsItWas) {
  for (const bool isUneven : {false, true}) {
    const Asset before = movingArm(isUneven);
    for (const EngineTarget& target : engineTargets()) {
      Asset after = before.clone();
      toTarget(after, target);
      checkAsset(after);
      EXPECT_LT(largestMove(before, after), kUnseen) << target.name << isUneven;
    }
  }
}

TEST(ToTarget, SeesAVertexThatMoves) {
  const Asset before = movingArm(false);
  Asset after = before.clone();
  after.document.nodes[3].translation = Vec3(0, 0.0101, 0);
  EXPECT_GT(largestMove(before, after), kUnseen);
}

TEST(ToTarget, LeavesAModelForGltfAndOneWithoutARigToTheByte) {
  Asset arm = movingArm(true);
  const Bytes armBefore = writeGlb(arm);
  toTarget(arm, findTarget("gltf"));
  EXPECT_EQ(writeGlb(arm), armBefore);
  SceneBuilder builder;
  builder.addScene({builder.addNode({{"name", "stone"}, {"mesh", builder.addTetrahedron()}})});
  Asset bare = builder.build();
  const Bytes bareBefore = writeGlb(bare);
  toTarget(bare, findTarget("unreal"));
  EXPECT_EQ(writeGlb(bare), bareBefore);
  ASSERT_EQ(bare.warnings.items().size(), 1u);
  EXPECT_EQ(bare.warnings.items()[0].kind, "no-skeleton");
}

// As it comes out of a file: joints in the order of the tree.
Motion readBack(const Asset& asset) {
  return motionOf(readAsset(writeGlb(asset), "walk.glb"));
}

// A person who goes ahead and moves all joints, without a surface.
Motion walk() {
  Motion motion;
  motion.name = "walk";
  motion.skeleton = testing::TargetPerson(testing::wordsOf("mixamo")).skeleton;
  constexpr int kFrames = 12;
  Clip& clip = motion.clips.emplace_back();
  clip.name = "walk";
  std::vector<float> times;
  for (int k = 0; k < kFrames; ++k) times.push_back(static_cast<float>(k) / 30);
  const Index hips = *motion.skeleton.find("mixamorig:Hips");
  auto& path = clip.translations.emplace_back();
  path.joint = hips;
  path.times = times;
  for (int k = 0; k < kFrames; ++k) {
    path.values.push_back(
        (motion.skeleton.joints[hips].rest.translation + Vec3(0.01 * k, 0.02 * std::sin(k), 0.05 * k)).cast<float>());
  }
  for (Index j = 0; j < motion.skeleton.jointCount(); ++j) {
    auto& track = clip.rotations.emplace_back();
    track.joint = j;
    track.times = times;
    for (int k = 0; k < kFrames; ++k) {
      const Vec3 axis = Vec3(1, 0.3 * j, 2).normalized();
      track.values.push_back(Quat(Eigen::AngleAxisd(0.4 * std::sin(0.5 * k + j), axis)).cast<float>());
    }
  }
  return readBack(motionAsset(motion));
}

std::vector<Affine> worldAt(const Motion& motion, double seconds) {
  Pose pose = restPose(motion.skeleton);
  sampleClip(motion.clips[0], seconds, pose);
  return poseGlobals(motion.skeleton, pose);
}

// The largest distance between joints of two motions at the frames of their clip, in metres; joints of `before` are the
// last of `after`.
double largestJointMove(const Motion& before, const Motion& after) {
  const Index added = after.skeleton.jointCount() - before.skeleton.jointCount();
  double moved = 0;
  for (const float time : before.clips[0].rotations[0].times) {
    const std::vector<Affine> a = worldAt(before, time), b = worldAt(after, time);
    for (Index j = 0; j < before.skeleton.jointCount(); ++j) {
      moved = std::max(moved, (a[j].translation() - b[j + added].translation()).norm());
    }
  }
  return moved;
}

TEST(ToTarget, MotionsWithoutASurfaceGetNamesRootAndAxes) {
  const Motion before = walk();
  for (const EngineTarget& target : engineTargets()) {
    Asset asset = motionAsset(before);
    toTarget(asset, target);
    checkAsset(asset);
    const Motion after = readBack(asset);
    EXPECT_EQ(after.skeleton.jointCount(), before.skeleton.jointCount() + (target.rootName.empty() ? 0 : 1));
    EXPECT_LT(largestJointMove(before, after), 1e-5) << target.name;
    if (!target.rootName.empty()) {
      EXPECT_EQ(after.skeleton.joints[0].name, target.rootName);
    }
    EXPECT_EQ(after.skeleton.find("thigh_l").has_value(), target.rootName == "root") << target.name;
    Motion alone = before;
    toTarget(alone, target);
    EXPECT_LT(largestJointMove(before, alone), 1e-5) << target.name;
    EXPECT_EQ(alone.skeleton.joints.back().name, after.skeleton.joints.back().name);
    EXPECT_EQ(alone.name, "walk");
  }
}

TEST(ToTarget, NodesThatMoveWithoutASkinAreAMotion) {
  Asset asset = motionAsset(walk());
  asset.document.skins.clear();
  const Motion before = motionOf(asset);
  toTarget(asset, findTarget("unreal"));
  const Motion after = readBack(asset);
  EXPECT_TRUE(after.skeleton.find("upperarm_r"));
  EXPECT_LT(largestJointMove(before, after), 1e-5);
}

TEST(ToTarget, AMotionInFbxHasTheTargetsNames) {
  const Motion before = walk();
  Asset asset = motionAsset(before);
  toTarget(asset, findTarget("unreal"));
  const Motion after = motionOf(readAsset(encodeFbx(asset, {}).bytes, "walk.fbx"));
  EXPECT_TRUE(after.skeleton.find("upperarm_r"));
  EXPECT_LT(largestJointMove(before, after), 1e-4);
}

TEST(ToTarget, SaysWhyASkeletonGetsNoRoot) {
  Asset arm = movingArm(false);
  std::vector<gltf::Node>& nodes = arm.document.nodes;
  nodes[2].children = {};
  gltf::Node stretched;
  stretched.scale = Vec3(1, 2, 1);
  stretched.children = {3};
  nodes[1].children.push_back(static_cast<Index>(nodes.size()));
  nodes.push_back(std::move(stretched));
  toTarget(arm, findTarget("unity"));
  ASSERT_EQ(arm.warnings.items().size(), 1u);
  EXPECT_EQ(arm.warnings.items()[0].kind, "no-root-joint");
  EXPECT_NE(arm.warnings.items()[0].message.find("stretched"), std::string::npos);
}

TEST(ToTarget, TurnsJointsOfUnevenScaleByQuartersAndSaysSo) {
  Asset arm = movingArm(true);
  toTarget(arm, findTarget("godot"));
  ASSERT_EQ(arm.warnings.items().size(), 1u);
  EXPECT_EQ(arm.warnings.items()[0].kind, "kept-axes");
}

TEST(ToTarget, NamesTheTargetsThatThereAre) {
  try {
    findTarget("maya");
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.remedy(),
              "there are: gltf, unreal, unity, godot, blender, vrm, mixamo, metahuman, rigify, "
              "actorcore, roblox");
  }
}

// A person in T-pose, called by VRM's names, its own axes those of the world, facing +Z.
Asset person() {
  struct Row {
    const char *name, *parent;
    Vec3 position;
  };
  std::vector<Row> rows = {{"hips", "", {0, 1, 0}},
                           {"spine", "hips", {0, 1.1, 0}},
                           {"chest", "spine", {0, 1.25, 0}},
                           {"upperChest", "chest", {0, 1.35, 0}},
                           {"neck", "upperChest", {0, 1.5, 0}},
                           {"head", "neck", {0, 1.6, 0}}};
  static const std::vector<std::pair<const char*, Vec3>> kLimbs = {{"UpperLeg", {0.1, 0.95, 0}},
                                                                   {"LowerLeg", {0.1, 0.5, 0}},
                                                                   {"Foot", {0.1, 0.08, 0}},
                                                                   {"Toes", {0.1, 0.02, 0.15}},
                                                                   {"Shoulder", {0.04, 1.42, 0}},
                                                                   {"UpperArm", {0.18, 1.42, 0}},
                                                                   {"LowerArm", {0.45, 1.42, 0}},
                                                                   {"Hand", {0.7, 1.42, 0}},
                                                                   {"MiddleProximal", {0.79, 1.42, 0}},
                                                                   {"MiddleIntermediate", {0.83, 1.42, 0}},
                                                                   {"MiddleDistal", {0.86, 1.42, 0}},
                                                                   {"Eye", {0.03, 1.68, 0.08}}};
  static const std::vector<const char*> kParents = {"hips",       "UpperLeg",       "LowerLeg",           "Foot",
                                                    "upperChest", "Shoulder",       "UpperArm",           "LowerArm",
                                                    "Hand",       "MiddleProximal", "MiddleIntermediate", "head"};
  SceneBuilder builder;
  std::vector<std::string> names;
  std::vector<std::optional<Index>> parents;
  std::vector<Vec3> positions;
  const auto add = [&](const std::string& name, const std::string& parent, const Vec3& position) {
    const auto found = std::find(names.begin(), names.end(), parent);
    parents.push_back(found == names.end() ? std::nullopt : std::optional(static_cast<Index>(found - names.begin())));
    names.push_back(name);
    positions.push_back(position);
  };
  for (const Row& row : rows) add(row.name, row.parent, row.position);
  for (const std::string side : {"left", "right"}) {
    for (std::size_t i = 0; i < kLimbs.size(); ++i) {
      Vec3 position = kLimbs[i].second;
      if (side == "right") position.x() = -position.x();
      const std::string parent = kParents[i];
      const bool central = parent == "hips" || parent == "upperChest" || parent == "head";
      add(side + kLimbs[i].first, central ? parent : side + parent, position);
    }
  }
  std::vector<Index> joints;
  std::vector<Affine> inverse;
  for (std::size_t j = 0; j < names.size(); ++j) {
    const Vec3 above = parents[j] ? positions[*parents[j]] : Vec3::Zero();
    const Vec3 local = positions[j] - above;
    joints.push_back(builder.addNode({{"name", names[j]}, {"translation", {local.x(), local.y(), local.z()}}}));
    inverse.push_back(testing::translation(-positions[j].x(), -positions[j].y(), -positions[j].z()));
    if (parents[j]) builder.node(joints[*parents[j]]).children.push_back(joints[j]);
  }
  const Index mesh = builder.addTetrahedron();
  builder.bindRigidly(mesh, {0, 5, 9, 12});
  builder.addSkin(joints, inverse);
  const Index shown = builder.addNode({{"name", "body"}, {"mesh", mesh}, {"skin", 0}});
  builder.addScene({joints.front(), shown});
  return builder.build();
}

struct Converted {
  Skeleton skeleton;
  std::vector<Affine> globals;

  explicit Converted(const char* target) {
    Asset asset = person();
    toTarget(asset, findTarget(target));
    skeleton = readSkeleton(asset).skeleton;
    globals = restGlobals(skeleton);
  }
  bool has(const char* name) const { return skeleton.find(name).has_value(); }
  // The joint's axes in the world, as columns.
  Mat3 axes(const char* name) const { return globals[*skeleton.find(name)].linear(); }
  Vec3 x(const char* name) const { return axes(name).col(0); }
  Vec3 y(const char* name) const { return axes(name).col(1); }
  Vec3 z(const char* name) const { return axes(name).col(2); }
};

constexpr double kAxis = 1e-6;

::testing::AssertionResult near(const Vec3& a, const Vec3& b) {
  if ((a - b).norm() < kAxis) return ::testing::AssertionSuccess();
  return ::testing::AssertionFailure() << a.transpose() << " is not " << b.transpose();
}

TEST(ToTarget, GivesUnrealItsNamesRootAndAxes) {
  const Converted unreal("unreal");
  EXPECT_EQ(unreal.skeleton.joints[0].name, "root");
  EXPECT_TRUE(unreal.globals[0].isApprox(Affine::Identity(), kAxis));
  EXPECT_EQ(unreal.skeleton.joints[1].name, "pelvis");
  for (const char* name : {"spine_01", "spine_03", "neck_01", "clavicle_l", "lowerarm_r", "middle_01_l", "ball_r"}) {
    EXPECT_TRUE(unreal.has(name)) << name;
  }
  const Vec3 left(1, 0, 0), up(0, 1, 0), front(0, 0, 1);
  EXPECT_TRUE(near(unreal.x("spine_01"), up));
  EXPECT_TRUE(near(unreal.x("upperarm_l"), left));
  EXPECT_TRUE(near(unreal.x("upperarm_r"), left));  // against the bone: all inverted on the right
  EXPECT_TRUE(near(unreal.y("upperarm_r"), front));
  EXPECT_TRUE(near(unreal.y("upperarm_l"), -front));
  EXPECT_TRUE(near(unreal.x("calf_l"), Vec3(0, 0.42, 0).normalized()));  // against the bone
  EXPECT_TRUE(near(unreal.x("calf_r"), -up));
  EXPECT_TRUE(near(unreal.x("foot_l"), up));
  EXPECT_TRUE(near(unreal.x("pelvis"), up));
}

TEST(ToTarget, GivesGodotTheAxesOfItsReferencePoses) {
  const Converted godot("godot");
  EXPECT_EQ(godot.skeleton.joints[0].name, "Root");
  const Vec3 left(1, 0, 0), up(0, 1, 0), front(0, 0, 1);
  // The products of the reference poses from the root down.
  EXPECT_TRUE(near(godot.y("Hips"), up));
  EXPECT_TRUE(near(godot.z("Hips"), front));
  EXPECT_TRUE(near(godot.y("LeftUpperArm"), left));
  EXPECT_TRUE(near(godot.z("LeftUpperArm"), -up));
  EXPECT_TRUE(near(godot.z("RightLowerArm"), front));
  EXPECT_TRUE(near(godot.y("RightLowerArm"), -left));
  EXPECT_TRUE(near(godot.x("LeftUpperLeg"), -left));
  EXPECT_TRUE(near(godot.x("LeftLowerLeg"), left));
}

// They have no child to tell where they look.
TEST(ToTarget, EyesLookToTheFront) {
  const Converted godot("godot"), blender("blender"), unreal("unreal");
  const Vec3 up(0, 1, 0), front(0, 0, 1);
  EXPECT_TRUE(near(godot.y("LeftEye"), front));
  EXPECT_TRUE(near(godot.z("LeftEye"), -up));
  EXPECT_TRUE(near(godot.z("RightEye"), -up));
  EXPECT_TRUE(near(blender.y("eye.R"), front));
  EXPECT_TRUE(near(unreal.x("eye_l"), front));
  EXPECT_TRUE(near(unreal.y("eye_l"), up));
}

TEST(BoneTurns, AJawWithoutAChildLooksToTheFront) {
  const Skeleton skeleton = readSkeleton(person()).skeleton;
  const Index jaw = *skeleton.find("leftEye");
  const std::vector<HumanoidJoint> bones = {{"jaw", jaw}};
  const Mat3 axes = boneTurns(skeleton, readAnatomy(skeleton), bones, BoneAxes::kAlongY)[jaw].toRotationMatrix();
  EXPECT_TRUE(near(axes.col(1), Vec3::UnitZ()));
  EXPECT_TRUE(near(axes.col(2), Vec3::UnitY()));
}

TEST(ToTarget, LeavesAxesThatVrmSpeaksOf) {
  Asset asset = person();
  const auto node = [&](const char* name) {
    const auto& nodes = asset.document.nodes;
    return static_cast<Index>(
        std::find_if(nodes.begin(), nodes.end(), [&](const gltf::Node& each) { return each.name == name; }) -
        nodes.begin());
  };
  const auto constrain = [&](const char* turned, const char* kind, const char* source) {
    asset.document.nodes[node(turned)].extensions.change()["VRMC_node_constraint"] = {
        {"constraint", {{kind, {{"source", node(source)}}}}}};
  };
  asset.document.extensions.change()["VRM"] = {
      {"humanoid", {{"humanBones", Json::array({{{"bone", "head"}, {"node", node("head")}}})}}}};
  constrain("leftMiddleDistal", "rotation", "leftUpperArm");
  constrain("rightHand", "roll", "rightUpperArm");
  const std::vector<std::pair<const char*, bool>> kept = {
      {"head", true},          {"leftMiddleDistal", true}, {"leftUpperArm", true},   {"leftShoulder", false},
      {"rightShoulder", true}, {"rightLowerArm", true},    {"rightUpperArm", false}, {"leftLowerArm", false}};
  std::vector<Index> numbers;
  for (const auto& [name, isKept] : kept) numbers.push_back(node(name));
  toTarget(asset, findTarget("godot"));
  const SceneGraph graph = readSceneGraph(asset.document);
  for (std::size_t i = 0; i < kept.size(); ++i) {
    const Mat3 axes = graph.world[numbers[i]].linear();
    EXPECT_EQ(axes.isIdentity(1e-6), kept[i].second) << kept[i].first;
  }
}

TEST(ToTarget, NamesPeopleAsOthersDo) {
  EXPECT_TRUE(Converted("unity").has("LeftMiddleProximal"));
  const Converted blender("blender"), mixamo("mixamo"), vrm("vrm");
  EXPECT_EQ(blender.skeleton.joints[0].name, "hips");  // no root is made
  for (const char* name : {"upper_chest", "thigh.L", "upper_arm.R", "f_middle.01.L"}) EXPECT_TRUE(blender.has(name));
  for (const char* name : {"mixamorig:Hips", "mixamorig:Spine2", "mixamorig:LeftUpLeg", "mixamorig:RightHandMiddle1"}) {
    EXPECT_TRUE(mixamo.has(name)) << name;
  }
  EXPECT_TRUE(vrm.has("leftUpperArm"));
}

TEST(ToTarget, IsReadAsWhatItWas) {
  const Skeleton before = readSkeleton(person()).skeleton;
  std::map<std::string_view, Vec3> expected;
  const std::vector<Affine> globals = restGlobals(before);
  for (const HumanoidJoint& joint : humanoidJoints(before)) expected[joint.bone] = globals[joint.joint].translation();
  ASSERT_EQ(expected.size(), before.joints.size());
  for (const EngineTarget& target : engineTargets()) {
    const Converted after(std::string(target.name).c_str());
    const std::vector<HumanoidJoint> joints = humanoidJoints(after.skeleton);
    EXPECT_EQ(joints.size(), expected.size()) << target.name;
    for (const HumanoidJoint& joint : joints) {
      EXPECT_TRUE(near(after.globals[joint.joint].translation(), expected[joint.bone])) << target.name << joint.bone;
    }
  }
}

TEST(ToTarget, GivesEveryNodeANameOfItsOwn) {
  Asset asset = person();
  asset.document.nodes.back().name = "pelvis";  // a mesh
  toTarget(asset, findTarget("unreal"));
  std::multiset<std::string> names;
  for (const gltf::Node& node : asset.document.nodes) names.insert(node.name);
  EXPECT_EQ(names.count("pelvis"), 1u);
  EXPECT_EQ(names.count("pelvis_2"), 1u);
}

TEST(ToTarget, TakesTheRootThatThereIs) {
  Asset asset = person();
  toTarget(asset, findTarget("unreal"));
  const std::size_t nodes = asset.document.nodes.size();
  toTarget(asset, findTarget("godot"));
  EXPECT_EQ(asset.document.nodes.size(), nodes);
  EXPECT_EQ(readSkeleton(asset).skeleton.joints[0].name, "Root");
}

TEST(ToTarget, TakesFramesAboveOutOfTheJoints) {
  Asset arm = movingArm(false);
  toTarget(arm, findTarget("unity"));
  const AssetSkeleton skeleton = readSkeleton(arm);
  for (const Affine& global : restGlobals(skeleton.skeleton)) EXPECT_NEAR(global.linear().determinant(), 1, 1e-4);
  for (const gltf::Node& node : arm.document.nodes) EXPECT_NE(node.name, "Armature");
}

}  // namespace
}  // namespace limber
