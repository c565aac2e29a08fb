#include "limber/actions/rig/auto_rig.h"

#include <algorithm>
#include <cmath>
#include <map>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "limber/document/gltf/accessor.h"
#include "limber/document/rig/rig_io.h"
#include "limber/document/testing/document_json.h"

namespace limber {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

// As a mesh on a node of its own.
void showPrimitive(Asset& asset, gltf::Primitive primitive, const char* name) {
  gltf::Mesh mesh;
  mesh.primitives.push_back(std::move(primitive));
  gltf::Node node;
  node.name = name;
  node.mesh = addElement(asset.document.meshes, std::move(mesh));
  asset.document.scenes[0].nodes.push_back(addElement(asset.document.nodes, std::move(node)));
}

// A cigar along x as a grid of rings, every vertex stored twice as exporters do at seams; lying off the origin.
Asset cigar(double scale = 1) {
  constexpr Index kRings = 13, kSides = 8;
  std::vector<float> positions;
  std::vector<std::uint32_t> corners;
  const auto vertex = [&](Index ring, Index side) {
    const double x = 2.0 * ring / (kRings - 1) - 1, angle = 2 * EIGEN_PI * (side % kSides) / kSides;
    const double radius = 0.3 * std::sqrt(std::max(0.0, 1.05 - x * x));
    for (const double c : {3 * x + 5, radius * std::cos(angle) - 2, radius * std::sin(angle)}) {
      positions.push_back(static_cast<float>(scale * c));
    }
    return static_cast<std::uint32_t>(positions.size() / 3 - 1);
  };
  for (Index ring = 0; ring + 1 < kRings; ++ring) {
    for (Index side = 0; side < kSides; ++side) {
      const std::uint32_t a = vertex(ring, side), b = vertex(ring, side + 1), c = vertex(ring + 1, side + 1),
                          d = vertex(ring + 1, side);
      corners.insert(corners.end(), {a, b, c, a, c, d});
    }
  }
  Asset asset;
  asset.name = "cigar.glb";
  gltf::Primitive primitive;
  primitive.attributes.set("POSITION", addFloatAccessor(asset, positions, 3, kVertexTarget, true));
  primitive.indices =
      addAccessor(asset, {static_cast<Index>(corners.size()), 1, ComponentType::kU32, false},
                  {reinterpret_cast<const std::uint8_t*>(corners.data()), 4 * corners.size()}, kIndexTarget);
  asset.document.scenes.emplace_back();
  showPrimitive(asset, std::move(primitive), "cigar");
  checkAsset(asset);
  return asset;
}

AutoRigOptions withHandles(Index handles) {
  AutoRigOptions options;
  options.rig.handles = handles;
  return options;
}

AutoRigReport rig(Asset& asset, const AutoRigOptions& options) {
  Progress progress;
  return autoRig(asset, options, progress);
}

Error errorOf(Asset& asset, const AutoRigOptions& options) {
  try {
    rig(asset, options);
  } catch (const Error& error) {
    return error;
  }
  ADD_FAILURE() << "no error";
  return Error(ErrorCode::kCancelled, "");
}

std::size_t bytesOf(const Asset& asset) {
  std::size_t bytes = 0;
  for (const Asset::Buffer& buffer : asset.buffers) bytes += buffer.bytes.size();
  return bytes;
}

TEST(AutoRig, MakesAStaticModelACharacter) {
  Asset asset = cigar();
  const AutoRigReport report = rig(asset, withHandles(5));
  checkAsset(asset);
  ASSERT_TRUE(hasRig(asset));
  EXPECT_EQ(report.sourceVertices, 12u * 8 * 4);
  EXPECT_EQ(report.weldedVertices, 13u * 8);
  EXPECT_EQ(report.triangles, 12u * 8 * 2);
  EXPECT_EQ(report.pieces, 1u);
  EXPECT_EQ(report.joints, 5u);
  EXPECT_FALSE(report.suggestions.empty());

  std::vector<std::string> stages;
  for (const StageTime& stage : report.stages) stages.push_back(stage.name);
  EXPECT_THAT(stages, ElementsAre("read geometry", "weld", "rig", "skin", "write rig"));
  EXPECT_FALSE(report.stages[2].steps.empty());  // those of the methods
  EXPECT_FALSE(report.stages[3].steps.empty());
  EXPECT_EQ(report.rigger, "sphere-mesh");
  EXPECT_TRUE(report.bridged.empty());

  const Geometry geometry = collectGeometry(asset);
  const AssetSkeleton skeleton = readSkeleton(asset);
  ASSERT_EQ(skeleton.skeleton.jointCount(), 5u);
  const SkinWeights weights = readWeights(asset, geometry, skeleton);
  for (Index v = 0; v < weights.vertexCount(); ++v) {
    float sum = 0;
    for (const float w : weights.weightsOf(v)) sum += w;
    EXPECT_NEAR(sum, 1, 1e-6);
  }
}

TEST(AutoRig, HandlesStandInTheModelInWorldSpace) {
  Asset asset = cigar(10);
  rig(asset, withHandles(5));
  const AssetSkeleton skeleton = readSkeleton(asset);
  const std::vector<Affine> globals = restGlobals(skeleton.skeleton);
  double thickest = 0;
  for (Index j = 0; j < 5; ++j) {
    const Vec3 p = globals[j].translation();
    EXPECT_GT(p.x(), 19);
    EXPECT_LT(p.x(), 81);
    EXPECT_LT(std::hypot(p.y() + 20, p.z()), 3.2);  // inside, or nearly
    EXPECT_LT(skeleton.skeleton.joints[j].radius, 6);
    thickest = std::max(thickest, skeleton.skeleton.joints[j].radius);
  }
  EXPECT_GT(thickest, 1.5);  // the model is 6 thick
}

TEST(AutoRig, VerticesAtOnePlaceHaveTheSameWeights) {
  Asset asset = cigar();
  rig(asset, withHandles(4));
  const Geometry geometry = collectGeometry(asset);
  const SkinWeights weights = readWeights(asset, geometry, readSkeleton(asset));
  std::map<std::array<float, 3>, Index> first;
  std::size_t pairs = 0;
  for (Index v = 0; v < weights.vertexCount(); ++v) {
    const Vec3f& p = geometry.positions[v];
    const auto [known, isNew] = first.try_emplace({p.x(), p.y(), p.z()}, v);
    if (isNew) continue;
    ++pairs;
    EXPECT_TRUE(std::ranges::equal(weights.jointsOf(v), weights.jointsOf(known->second)));
    EXPECT_TRUE(std::ranges::equal(weights.weightsOf(v), weights.weightsOf(known->second)));
  }
  EXPECT_GT(pairs, 100u);
}

TEST(AutoRig, ARiggedModelIsRefusedUnlessToldWhatToDo) {
  Asset asset = cigar();
  rig(asset, withHandles(3));
  const Json before = testing::documentJson(asset);
  const Error error = errorOf(asset, withHandles(4));
  EXPECT_EQ(error.code(), ErrorCode::kUnsupported);
  EXPECT_THAT(error.what(), HasSubstr("`existing-rig: replace`"));
  EXPECT_THAT(error.what(), HasSubstr("`existing-rig: keep-skeleton`"));
  EXPECT_EQ(testing::documentJson(asset), before);
}

TEST(AutoRig, ReplacingTheRigIsRiggingTheBareModel) {
  Asset bare = cigar(), rigged = cigar();
  rig(rigged, withHandles(3));
  AutoRigOptions options = withHandles(4);
  options.existingRig = ExistingRig::kReplace;
  const AutoRigReport report = rig(rigged, options);
  EXPECT_EQ(report.removedJoints, 3u);
  EXPECT_EQ(report.removedClips, 0u);
  EXPECT_EQ(rig(bare, options).removedJoints, 0u);
  EXPECT_EQ(testing::documentJson(rigged)["nodes"], testing::documentJson(bare)["nodes"]);
  const Geometry geometry = collectGeometry(bare);
  EXPECT_EQ(readWeights(rigged, geometry, readSkeleton(rigged)).weights,
            readWeights(bare, geometry, readSkeleton(bare)).weights);
}

TEST(AutoRig, KeepingTheSkeletonMakesOnlyWeights) {
  Asset asset = cigar();
  rig(asset, withHandles(4));
  const Json before = testing::documentJson(asset);
  AutoRigOptions options;
  options.existingRig = ExistingRig::kKeepSkeleton;
  options.weights.maxInfluences = 1;
  const AutoRigReport report = rig(asset, options);
  EXPECT_EQ(report.joints, 4u);
  EXPECT_TRUE(report.suggestions.empty());
  const Json after = testing::documentJson(asset);
  EXPECT_EQ(after["nodes"], before["nodes"]);
  EXPECT_EQ(after["skins"], before["skins"]);
  const SkinWeights weights = readWeights(asset, collectGeometry(asset), readSkeleton(asset));
  for (Index v = 0; v < weights.vertexCount(); ++v) EXPECT_EQ(weights.weightsOf(v)[0], 1);
}

TEST(AutoRig, AJointThatMovedNothingMovesNothingNow) {
  Asset asset = cigar();
  rig(asset, withHandles(3));
  // A control in the middle of the model that no vertex follows.
  gltf::Node node;
  node.name = "control";
  node.translation = Vec3(5, -2, 0);
  const Index control = addElement(asset.document.nodes, std::move(node));
  for (gltf::Node& root : asset.document.nodes) {
    if (root.name == "limber_rig") root.children.push_back(control);
  }
  gltf::Skin& skin = asset.document.skins[0];
  std::vector<float> binds = readFloats(asset, *skin.inverseBindMatrices);
  binds.insert(binds.end(), {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, -5, 2, 0, 1});
  skin.inverseBindMatrices = addFloatAccessor(asset, binds, 16);
  skin.joints.push_back(control);
  checkAsset(asset);

  AutoRigOptions options;
  options.existingRig = ExistingRig::kKeepSkeleton;
  EXPECT_EQ(rig(asset, options).joints, 4u);
  const AssetSkeleton skeleton = readSkeleton(asset);
  const Index joint = *skeleton.skeleton.find("control");
  const SkinWeights weights = readWeights(asset, collectGeometry(asset), skeleton);
  for (std::size_t i = 0; i < weights.weights.size(); ++i) {
    if (weights.weights[i] > 0) {
      EXPECT_NE(weights.joints[i], joint);
    }
  }
}

TEST(AutoRig, NodesThatNoBoneReachesAreNamed) {
  Asset asset = cigar();
  const std::vector<float> dust = {5, -1, 0, 5, -1, 0.1f, 6, -1, 0};
  gltf::Primitive primitive;
  primitive.attributes.set("POSITION", addFloatAccessor(asset, dust, 3, kVertexTarget, true));
  primitive.mode = 0;  // points
  showPrimitive(asset, std::move(primitive), "dust");
  checkAsset(asset);
  const AutoRigReport report = rig(asset, withHandles(3));
  ASSERT_EQ(report.bridged.size(), 1u);
  EXPECT_EQ(report.bridged[0].name, "dust");
  EXPECT_EQ(report.bridged[0].vertices, 3u);
  EXPECT_EQ(report.bridged[0].bridged, 3u);
  std::map<std::string, Warning> warnings;
  for (const Warning& warning : report.warnings.items()) warnings[warning.kind] = warning;
  EXPECT_EQ(warnings["bridged-pieces"].count, 3u);
  EXPECT_EQ(warnings["bridged-vertices"].count, 3u);
  EXPECT_EQ(warnings["bridged-vertices"].where, "dust");
}

TEST(AutoRig, AKeptSkeletonOfWhichOneJointHoldsAllIsWarnedOf) {
  Asset asset = cigar();
  const Geometry geometry = collectGeometry(asset);
  Skeleton skeleton;
  skeleton.joints = {{"hips", std::nullopt, {}, 0}, {"head", Index{0}, {}, 0}};
  SkinWeights weights;
  weights.slots = 1;
  weights.joints.assign(geometry.positions.size(), 1);
  weights.weights.assign(geometry.positions.size(), 1);
  attachRig(asset, geometry, skeleton, weights);
  AutoRigOptions options;
  options.existingRig = ExistingRig::kKeepSkeleton;
  const AutoRigReport report = rig(asset, options);
  ASSERT_EQ(report.warnings.items().size(), 1u);
  EXPECT_EQ(report.warnings.items()[0].kind, "single-joint");
  EXPECT_EQ(report.warnings.items()[0].where, "head");
}

TEST(AutoRig, ErrorsNameTheFile) {
  Asset asset = cigar();
  EXPECT_EQ(errorOf(asset, withHandles(100000)).where(), "cigar.glb");
  asset.document.scenes[0].nodes.clear();
  EXPECT_STREQ(errorOf(asset, withHandles(3)).what(),
               "cigar.glb: has no triangle (limber needs a surface, not points or lines)");
}

TEST(AutoRig, KeepingASkeletonThatIsNotThereIsAnError) {
  Asset asset = cigar();
  AutoRigOptions options;
  options.existingRig = ExistingRig::kKeepSkeleton;
  EXPECT_EQ(errorOf(asset, options).code(), ErrorCode::kBadArgument);
}

TEST(AutoRig, WrongNamesAreToldBeforeAnyWork) {
  Asset asset = cigar();
  AutoRigOptions options;
  options.rigger = "magic";
  EXPECT_THAT(errorOf(asset, options).what(), HasSubstr("sphere-mesh"));
  options = {};
  options.skinning = "magic";
  EXPECT_THAT(errorOf(asset, options).what(), HasSubstr("bone-heat"));
}

TEST(AutoRig, CancellingLeavesTheAssetAsItWas) {
  for (const char* stage : {"weld", "rig", "skin", "write rig"}) {
    Asset asset = cigar();
    rig(asset, withHandles(3));
    const Json json = testing::documentJson(asset);
    const std::size_t bytes = bytesOf(asset);
    Progress* running = nullptr;
    Progress progress([&](std::string_view name, double) {
      if (name == stage) running->cancel();
    });
    running = &progress;
    AutoRigOptions options = withHandles(4);
    options.existingRig = ExistingRig::kReplace;
    bool cancelled = false;
    try {
      autoRig(asset, options, progress);
    } catch (const Error& error) {
      cancelled = error.code() == ErrorCode::kCancelled;
    }
    if (stage == std::string_view("write rig")) continue;  // past the last question: it may well be finished
    EXPECT_TRUE(cancelled) << stage;
    EXPECT_EQ(testing::documentJson(asset), json) << stage;
    EXPECT_EQ(bytesOf(asset), bytes) << stage;
  }
}

TEST(AutoRig, WarningsOfReadingAndOfStagesComeTogether) {
  Asset asset = cigar();
  asset.warnings.add("from-reading", "something was converted");
  std::vector<std::uint32_t> corners = {0, 0, 1, 0, 1, 2};
  gltf::Primitive degenerate = asset.document.meshes[0].primitives[0];
  degenerate.indices = addAccessor(asset, {6, 1, ComponentType::kU32, false},
                                   {reinterpret_cast<const std::uint8_t*>(corners.data()), 24}, kIndexTarget);
  asset.document.meshes[0].primitives.push_back(std::move(degenerate));
  const AutoRigReport report = rig(asset, withHandles(3));
  std::vector<std::string> kinds;
  for (const Warning& w : report.warnings.items()) kinds.push_back(w.kind);
  EXPECT_THAT(kinds, ::testing::IsSupersetOf({"from-reading", "degenerate-triangles"}));
}

}  // namespace
}  // namespace limber
