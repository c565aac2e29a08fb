#include "limber/actions/pose/pose_asset.h"

#include <algorithm>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "limber/core/error.h"
#include "limber/document/gltf/accessor.h"
#include "limber/document/read.h"
#include "limber/document/rig/bind_pose.h"
#include "limber/document/rig/pose_io.h"
#include "limber/document/rig/rest_pose.h"
#include "limber/document/testing/document_json.h"
#include "limber/document/write.h"
#include "warning_kinds.h"

namespace limber {
namespace {

// A strip of six triangles along +Y from 0 to 3, width 0.2, below a node that moves it by (5, 0, 0); then rigged with
// three joints at y = 0, 1, 2: "hip", "knee", "foot".
Asset strip() {
  Asset asset;
  std::vector<float> positions, normals;
  std::vector<std::uint16_t> indices;
  for (int i = 0; i < 4; ++i) {
    for (const float x : {-0.1f, 0.1f}) {
      positions.insert(positions.end(), {x, static_cast<float>(i), 0});
      normals.insert(normals.end(), {0, 0, 1});
    }
    const auto v = static_cast<std::uint16_t>(2 * i);
    for (const int corner : {0, 1, 2, 2, 1, 3}) {
      if (i < 3) indices.push_back(static_cast<std::uint16_t>(v + corner));
    }
  }
  gltf::Primitive primitive;
  primitive.attributes.set("POSITION", addFloatAccessor(asset, positions, 3, kVertexTarget, true));
  primitive.attributes.set("NORMAL", addFloatAccessor(asset, normals, 3, kVertexTarget));
  const auto* bytes = reinterpret_cast<const std::uint8_t*>(indices.data());
  const AccessorInfo info{static_cast<Index>(indices.size()), 1, ComponentType::kU16, false};
  primitive.indices = addAccessor(asset, info, {bytes, 2 * indices.size()}, kIndexTarget);
  gltf::Document& document = asset.document;
  document.meshes.emplace_back().primitives.push_back(std::move(primitive));
  gltf::Node& node = document.nodes.emplace_back();
  node.name = "strip";
  node.mesh = 0;
  node.translation = Vec3(5, 0, 0);
  document.scenes.emplace_back().nodes = {0};
  document.scene = 0;
  return asset;
}

SkinWeights stripWeights() {
  SkinWeights weights;
  weights.slots = 1;
  for (Index v = 0; v < 8; ++v) weights.joints.push_back(std::min(v / 2, Index{2}));
  weights.weights.assign(8, 1.0f);
  return weights;
}

// Every vertex between two joints.
SkinWeights blendedWeights() {
  SkinWeights weights;
  weights.slots = 2;
  for (Index v = 0; v < 8; ++v) {
    weights.joints.insert(weights.joints.end(), {std::min(v / 2, Index{1}), std::min(v / 2, Index{1}) + 1});
    weights.weights.insert(weights.weights.end(), {0.6f, 0.4f});
  }
  return weights;
}

Asset riggedStrip(const SkinWeights& weights = stripWeights()) {
  Asset asset = strip();
  const Geometry geometry = collectGeometry(asset);
  Skeleton skeleton;
  for (const char* name : {"hip", "knee", "foot"}) {
    Joint joint;
    joint.name = name;
    if (!skeleton.joints.empty()) joint.parent = skeleton.jointCount() - 1;
    joint.rest.translation = skeleton.joints.empty() ? Vec3(5, 0, 0) : Vec3(0, 1, 0);
    skeleton.joints.push_back(joint);
  }
  attachRig(asset, geometry, skeleton, weights);
  checkAsset(asset);
  return asset;
}

PoseEdits turned(const char* text) {
  PoseEdits edits;
  edits.turns = parseTurn(text);
  return edits;
}

Vec3 jointAt(const AssetSkeleton& skeleton, const Pose& pose, const char* name) {
  return poseGlobals(skeleton.skeleton, pose)[*skeleton.skeleton.find(name)].translation();
}

TEST(PoseAsset, NodesOfAFreshRigStandInTheBindPose) {
  const Asset asset = riggedStrip();
  const AssetSkeleton skeleton = readSkeleton(asset);
  const Pose pose = readNodePose(asset, skeleton);
  EXPECT_LT((jointAt(skeleton, pose, "foot") - Vec3(5, 2, 0)).norm(), 1e-6);
  const PosedGeometry posed = posedGeometry(asset, skeleton, pose);
  EXPECT_EQ(posed.geometry.positions, collectGeometry(asset).positions);
}

TEST(PoseAsset, ATurnIsAboutTheWorldsAxisThroughTheJoint) {
  const Asset asset = riggedStrip();
  const AssetSkeleton skeleton = readSkeleton(asset);
  Pose pose = readNodePose(asset, skeleton);
  editPose(skeleton.skeleton, pose, turned("hip=z:90"));
  EXPECT_LT((jointAt(skeleton, pose, "foot") - Vec3(3, 0, 0)).norm(), 1e-6);
  // Again about the world's z, though the knee's own axes have turned by now.
  editPose(skeleton.skeleton, pose, turned("knee=z:-90"));
  EXPECT_LT((jointAt(skeleton, pose, "foot") - Vec3(4, 1, 0)).norm(), 1e-6);
  editPose(skeleton.skeleton, pose, turned("knee=y:90"));
  EXPECT_LT((jointAt(skeleton, pose, "foot") - Vec3(4, 1, 0)).norm(), 1e-6);

  const PosedGeometry posed = posedGeometry(asset, skeleton, pose);
  EXPECT_LT((posed.geometry.positions[6].cast<double>() - Vec3(4, 2, 0.1)).norm(), 1e-5);
  EXPECT_LT((posed.normals[6].cast<double>() - Vec3(1, 0, 0)).norm(), 1e-5);
}

TEST(PoseAsset, AMoveTakesWhatHangsOnTheJointAlong) {
  const Asset asset = riggedStrip();
  const AssetSkeleton skeleton = readSkeleton(asset);
  Pose pose = readNodePose(asset, skeleton);
  PoseEdits edits = turned("hip=z:90");
  edits.moves.push_back(parseMove("knee=0,0.5,0"));
  editPose(skeleton.skeleton, pose, edits);
  EXPECT_LT((jointAt(skeleton, pose, "knee") - Vec3(4, 0.5, 0)).norm(), 1e-6);
  EXPECT_LT((jointAt(skeleton, pose, "foot") - Vec3(3, 0.5, 0)).norm(), 1e-6);
}

TEST(PoseAsset, AScaleIsAboutTheJointAndTakesWhatHangsOnItAlong) {
  const Asset asset = riggedStrip();
  const AssetSkeleton skeleton = readSkeleton(asset);
  Pose pose = readNodePose(asset, skeleton);
  const Vec3 hip = jointAt(skeleton, pose, "hip"), knee = jointAt(skeleton, pose, "knee"),
             foot = jointAt(skeleton, pose, "foot");
  PoseEdits edits;
  edits.scales = {parseScale("knee=2"), parseScale("knee=1.5")};
  editPose(skeleton.skeleton, pose, edits);
  EXPECT_EQ(jointAt(skeleton, pose, "hip"), hip);
  EXPECT_LT((jointAt(skeleton, pose, "knee") - knee).norm(), 1e-6);
  EXPECT_LT((jointAt(skeleton, pose, "foot") - knee - 3 * (foot - knee)).norm(), 1e-6);
  edits.scales = {parseScale("elbow=2")};
  EXPECT_THROW(editPose(skeleton.skeleton, pose, edits), Error);
}

TEST(PoseAsset, AReachTellsWhatIsLeft) {
  const Asset asset = riggedStrip();
  const AssetSkeleton skeleton = readSkeleton(asset);
  Pose pose = readNodePose(asset, skeleton);
  PoseEdits edits;
  edits.reaches.push_back(parseReach("foot=6,1,0"));
  std::vector<ReachReport> reports = editPose(skeleton.skeleton, pose, edits);
  ASSERT_EQ(reports.size(), 1u);
  EXPECT_EQ(reports[0].outcome, IkOutcome::kReached);
  EXPECT_LT((jointAt(skeleton, pose, "foot") - Vec3(6, 1, 0)).norm(), 1e-3);

  edits.reaches[0].target = Vec3(5, 7, 0);
  reports = editPose(skeleton.skeleton, pose, edits);
  EXPECT_EQ(reports[0].outcome, IkOutcome::kOutOfReach);
  EXPECT_NEAR(reports[0].distance, 5, 0.05);
}

TEST(PoseAsset, AnUnknownJointIsNamedWithThoseThereAre) {
  const AssetSkeleton skeleton = readSkeleton(riggedStrip());
  Pose pose = restPose(skeleton.skeleton);
  try {
    editPose(skeleton.skeleton, pose, turned("tail=x:10"));
    FAIL() << "turned a joint that is not there";
  } catch (const Error& error) {
    EXPECT_THAT(error.what(),
                ::testing::AllOf(::testing::HasSubstr("'tail'"), ::testing::HasSubstr("hip, knee, foot")));
  }
}

TEST(PoseIo, AWrittenPoseIsReadAgainAndTouchesOnlyWhatMoved) {
  Asset asset = riggedStrip();
  const AssetSkeleton skeleton = readSkeleton(asset);
  Pose pose = readNodePose(asset, skeleton);
  const Json before = testing::documentJson(asset);
  writeNodePose(asset, skeleton, pose);
  EXPECT_EQ(testing::documentJson(asset), before);

  editPose(skeleton.skeleton, pose, turned("knee=x:40,y:20"));
  const PosedGeometry here = posedGeometry(asset, skeleton, pose);
  writeNodePose(asset, skeleton, pose);
  checkAsset(asset);
  const Bytes glb = writeGlb(asset);
  const Asset back = readAsset(glb, "posed.glb");
  const AssetSkeleton again = readSkeleton(back);
  const Pose stance = readNodePose(back, again);
  EXPECT_LT((jointAt(again, stance, "foot") - jointAt(skeleton, pose, "foot")).norm(), 1e-6);
  const Json after = testing::documentJson(asset);
  for (std::size_t n = 0; n < before["nodes"].size(); ++n) {
    const bool moved = n == skeleton.jointNode[1];
    EXPECT_EQ(after["nodes"][n] == before["nodes"][n], !moved);
  }
  // The binding stays the same: the vertices are where the pose takes them.
  const PosedGeometry there = posedGeometry(back, again, stance);
  for (std::size_t v = 0; v < here.geometry.positions.size(); ++v) {
    EXPECT_LT((here.geometry.positions[v] - there.geometry.positions[v]).norm(), 1e-5f);
  }
}

TEST(AssetPoser, PosesAgainAndAgainByEveryDeformer) {
  const Asset asset = riggedStrip();
  const AssetSkeleton skeleton = readSkeleton(asset);
  const Pose rest = readNodePose(asset, skeleton);
  Pose pose = rest;
  editPose(skeleton.skeleton, pose, turned("knee=x:40,y:20"));
  const Geometry bound = collectGeometry(asset);
  for (const Deformer& deformer : deformers()) {
    const AssetPoser poser(asset, skeleton, deformer);
    const PosedGeometry bent = poser.posed(pose), still = poser.posed(rest), again = poser.posed(pose);
    const std::vector<Vec3f> once = posedGeometry(asset, skeleton, pose, deformer).geometry.positions;
    EXPECT_EQ(bent.geometry.positions, again.geometry.positions) << deformer.name;
    EXPECT_EQ(bent.geometry.positions, once) << deformer.name;
    EXPECT_NE(bent.geometry.positions, still.geometry.positions) << deformer.name;
    for (std::size_t v = 0; v < bound.positions.size(); ++v) {
      EXPECT_LT((still.geometry.positions[v] - bound.positions[v]).norm(), 1e-5f) << deformer.name << " " << v;
    }
    for (const Vec3f& normal : bent.normals) EXPECT_NEAR(normal.norm(), 1, 1e-4) << deformer.name;
  }
}

// A shape that moves all by half a metre along +Z: as if the vertices were stored there.
TEST(PoseAsset, BlendShapesComeBeforeTheSkin) {
  Asset asset = riggedStrip(), moved = riggedStrip();
  const auto meshOf = [](Asset& of) -> gltf::Mesh& {
    const auto shows = [](const gltf::Node& node) { return node.skin.has_value(); };
    const std::vector<gltf::Node>& nodes = of.document.nodes;
    return of.document.meshes[*std::find_if(nodes.begin(), nodes.end(), shows)->mesh];
  };
  std::vector<float> offsets;
  for (int v = 0; v < 8; ++v) offsets.insert(offsets.end(), {0, 0, 0.5f});
  gltf::Mesh& mesh = meshOf(asset);
  mesh.primitives[0].targets.emplace_back().set("POSITION", addFloatAccessor(asset, offsets, 3, kVertexTarget, true));
  mesh.weights = {1};
  gltf::Attributes& attributes = meshOf(moved).primitives[0].attributes;
  std::vector<float> positions = readFloats(moved, *attributes.find("POSITION"));
  for (std::size_t i = 2; i < positions.size(); i += 3) positions[i] += 0.5f;
  attributes.set("POSITION", addFloatAccessor(moved, positions, 3, kVertexTarget, true));

  const AssetSkeleton skeleton = readSkeleton(asset);
  Pose pose = readNodePose(asset, skeleton);
  editPose(skeleton.skeleton, pose, turned("knee=x:70"));
  const std::vector<Vec3f> wanted = posedGeometry(moved, skeleton, pose).geometry.positions;
  const AssetPoser poser(asset, skeleton, kLinearBlendDeformer);
  const std::vector<Vec3f> posed = poser.posed(pose).geometry.positions;
  ShapeWeights none = readShapeWeights(asset);
  for (std::vector<float>& weights : none) weights.assign(weights.size(), 0.0f);
  const std::vector<Vec3f> plain = poser.posed(pose, none).geometry.positions;
  const std::vector<Vec3f> before = posedGeometry(riggedStrip(), skeleton, pose).geometry.positions;
  for (std::size_t v = 0; v < wanted.size(); ++v) {
    EXPECT_LT((posed[v] - wanted[v]).norm(), 1e-5f) << v;
    EXPECT_LT((plain[v] - before[v]).norm(), 1e-6f) << v;
  }
}

// The strip once more, by a skin that was bound with each joint turned about itself.
Asset stripInTwoBinds() {
  Asset asset = riggedStrip(blendedWeights());
  gltf::Document& document = asset.document;
  gltf::Skin skin = document.skins.at(0);
  std::vector<float> binds = readFloats(asset, skin.inverseBindMatrices.value());
  for (std::size_t j = 0; j < skin.joints.size(); ++j) {
    Eigen::Map<Eigen::Matrix4f> bind(&binds[16 * j]);
    Eigen::Affine3f turned(Eigen::AngleAxisf(0.4f * static_cast<float>(j + 1), Vec3f(1, 2, 3).normalized()));
    turned.translation() = Vec3f(0.1f, 0.2f, 0.3f) * static_cast<float>(j);
    bind = turned.matrix() * bind;
  }
  skin.inverseBindMatrices = addFloatAccessor(asset, binds, 16);
  const auto shown = std::find_if(document.nodes.begin(), document.nodes.end(),
                                  [](const gltf::Node& node) { return node.mesh && node.skin; });
  gltf::Node again = *shown;
  again.skin = addElement(document.skins, std::move(skin));
  const Index added = addElement(document.nodes, std::move(again));
  document.scenes.at(0).nodes.push_back(added);
  checkAsset(asset);
  return asset;
}

TEST(PoseAsset, SkinsInTwoBindsAreMovedByTheirOwn) {
  const Asset asset = stripInTwoBinds();
  const AssetSkeleton skeleton = readSkeleton(asset);
  ASSERT_TRUE(withJoinedBinds(asset));
  for (const char* edit : {"knee=z:0", "knee=z:80"}) {
    Pose pose = readNodePose(asset, skeleton);
    editPose(skeleton.skeleton, pose, turned(edit));
    const std::vector<Affine> joints = poseGlobals(skeleton.skeleton, pose);
    const PosedGeometry posed = posedGeometry(asset, skeleton, pose);
    const SkinWeights weights = readWeights(asset, posed.geometry, skeleton);
    ASSERT_EQ(posed.geometry.instances.size(), 2u);
    for (const PrimitiveInstance& instance : posed.geometry.instances) {
      const SkinBinding binding = readSkinBinding(asset, asset.document.nodes[instance.node].skin.value());
      const gltf::Attributes& attributes = asset.document.meshes[0].primitives[0].attributes;
      const std::vector<float> stored = readFloats(asset, attributes.find("POSITION").value());
      for (Index v = 0; v < instance.vertexCount; ++v) {
        const Vec3 local = Vec3f(&stored[std::size_t{3} * v]).cast<double>();
        Vec3 wanted = Vec3::Zero();
        for (std::size_t s = 0; s < weights.slots; ++s) {
          const Index joint = weights.jointsOf(instance.firstVertex + v)[s];
          const auto at = std::find(binding.joints.begin(), binding.joints.end(), skeleton.jointNode[joint]);
          const Affine& bind = binding.inverseBinds[static_cast<std::size_t>(at - binding.joints.begin())];
          wanted += weights.weightsOf(instance.firstVertex + v)[s] * (joints[joint] * bind * local);
        }
        const Vec3f got = posed.geometry.positions[instance.firstVertex + v];
        EXPECT_LT((got.cast<double>() - wanted).norm(), 1e-5) << edit << " " << instance.node << " " << v;
      }
    }
  }
}

TEST(PoseIo, AFrozenMeshStandsInThePoseWithoutARig) {
  Asset asset = riggedStrip();
  const AssetSkeleton skeleton = readSkeleton(asset);
  Pose pose = readNodePose(asset, skeleton);
  editPose(skeleton.skeleton, pose, turned("hip=z:90"));
  const PosedGeometry posed = posedGeometry(asset, skeleton, pose);
  freezeGeometry(asset, collectGeometry(asset), posed.geometry.positions, posed.normals);
  checkAsset(asset);
  EXPECT_FALSE(hasRig(asset));
  EXPECT_FALSE(testing::documentJson(asset).contains("skins"));
  const Geometry frozen = collectGeometry(asset);
  EXPECT_EQ(frozen.positions, posed.geometry.positions);
  EXPECT_EQ(readNormals(asset, frozen), posed.normals);
  EXPECT_EQ(frozen.triangles, posed.geometry.triangles);
}

TEST(PoseIo, FrozenJointsBeyondEightOfAVertexAreReported) {
  Asset asset = riggedStrip();
  gltf::Attributes& attributes = asset.document.meshes.at(0).primitives.at(0).attributes;
  attributes.set("JOINTS_2", attributes.find("JOINTS_0").value());
  attributes.set("WEIGHTS_2", attributes.find("WEIGHTS_0").value());
  const Geometry geometry = collectGeometry(asset);
  freezeGeometry(asset, geometry, geometry.positions, readNormals(asset, geometry));
  EXPECT_EQ(testing::countOf(asset.warnings, "many-influences"), 1u);
}

TEST(PoseIo, AMirroredPartKeepsItsOutside) {
  Asset asset = strip();
  asset.document.nodes[0].scale = Vec3(-1, 1, 1);
  const Geometry geometry = collectGeometry(asset);
  freezeGeometry(asset, geometry, geometry.positions, readNormals(asset, geometry));
  checkAsset(asset);
  const Geometry frozen = collectGeometry(asset);
  EXPECT_EQ(frozen.positions, geometry.positions);
  EXPECT_EQ(frozen.triangles, geometry.triangles);
}

TEST(PoseAsset, EditsThatCannotBeMadeAreNamedByTheirPlace) {
  const AssetSkeleton skeleton = readSkeleton(riggedStrip());
  const auto errorOfPose = [&](const std::string& lists) {
    const std::vector<NamedPose> poses = parsePoses(R"({"poses": [{"name": "a", )" + lists + "}]}", "p.json");
    Pose pose = restPose(skeleton.skeleton);
    try {
      editPose(skeleton.skeleton, pose, poses[0].edits);
    } catch (const Error& error) {
      return std::string(error.what());
    }
    return std::string("no error");
  };
  using ::testing::StartsWith;
  EXPECT_THAT(errorOfPose(R"("turn": [{"joint": "hip", "axis": [0, 1, 0], "degrees": 1},
                                      {"joint": "hop", "axis": [0, 1, 0], "degrees": 1}])"),
              StartsWith("p.json: poses[0].turn[1]: no joint is called 'hop'"));
  EXPECT_THAT(errorOfPose(R"("move": [{"joint": "hop", "offset": [0, 1, 0]}])"),
              StartsWith("p.json: poses[0].move[0]: no joint is called 'hop' (there are: hip, knee, foot"));
  EXPECT_THAT(errorOfPose(R"("reach": [{"joint": "hop", "target": [0, 1, 0]}])"),
              StartsWith("p.json: poses[0].reach[0]: no joint is called 'hop'"));
  EXPECT_THAT(errorOfPose(R"("reach": [{"joint": "foot", "target": [0, 1, 0], "base": "hop"}])"),
              StartsWith("p.json: poses[0].reach[0]: no joint is called 'hop'"));
  EXPECT_THAT(errorOfPose(R"("reach": [{"joint": "knee", "target": [0, 1, 0], "base": "foot"}])"),
              StartsWith("p.json: poses[0].reach[0]: the base 'foot' is not above the joint 'knee'"));
  EXPECT_THAT(
      errorOfPose(R"("reach": [{"joint": "foot", "target": [5, 1, 0]}, {"joint": "foot", "target": [5, 2, 0]}])"),
      StartsWith("p.json: poses[0].reach[1]: joint 'foot' already reaches for another point"));

  Pose pose = restPose(skeleton.skeleton);
  try {
    editPose(skeleton.skeleton, pose, turned("hop=y:30"));
    FAIL() << "an unknown joint was turned";
  } catch (const Error& error) {
    EXPECT_THAT(error.what(), StartsWith("'hop=y:30': no joint is called 'hop'"));
  }
}

}  // namespace
}  // namespace limber
