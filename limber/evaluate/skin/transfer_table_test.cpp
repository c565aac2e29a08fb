#include "limber/evaluate/skin/transfer_table.h"

#include <gmock/gmock.h>

#include "limber/character/matching/testing/test_motion.h"
#include "limber/document/read.h"
#include "limber/document/rig/rig_io.h"
#include "limber/document/testing/scene_builder.h"
#include "limber/document/write.h"
#include "limber/geometry/mesh/testing/capsule.h"
#include "temporary_folder.h"

namespace limber {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

// A capsule along each bone of a person, each vertex on the joint of its bone; joints have other names by a maker's
// ending.
Asset capsuleCharacter(const std::string& maker) {
  Skeleton skeleton = practiceHumanoid();
  const std::vector<Affine> globals = restGlobals(skeleton);
  TriMesh mesh;
  SkinWeights weights;
  weights.slots = 1;
  for (Index j = 0; j < skeleton.jointCount(); ++j) {
    const std::optional<Index> parent = skeleton.joints[j].parent;
    if (!parent) continue;
    testing::addCapsule(mesh, globals[*parent].translation(), globals[j].translation(), 0.05);
    weights.joints.resize(mesh.positions.size(), *parent);
  }
  weights.weights.assign(weights.joints.size(), 1.0f);
  for (Joint& joint : skeleton.joints) joint.name += maker;
  testing::SceneBuilder scene;
  Json primitives = Json::array({scene.primitive(mesh.positions, mesh.triangles)});
  scene.addScene({scene.addNode({{"mesh", scene.addMesh(std::move(primitives))}})});
  Asset asset = scene.build();
  attachRig(asset, collectGeometry(asset), skeleton, weights);
  return asset;
}

// The joints of the source where they are, and its weights vertex by vertex: right for models that are one.
void copyRig(const Asset& source, Asset& target, const Vec3& shift = Vec3::Zero()) {
  const AssetSkeleton skeleton = readSkeleton(source);
  const Geometry geometry = collectGeometry(source);
  Skeleton moved = skeleton.skeleton;
  for (Joint& joint : moved.joints) {
    if (!joint.parent) joint.rest.translation += shift;
  }
  attachRig(target, collectGeometry(target), moved, readWeights(source, geometry, skeleton));
}

std::vector<TransferTrial> trialsOver(const std::vector<std::pair<std::string, std::string>>& filesAndMakers,
                                      const TransferFunction& transfer, Warnings& skipped,
                                      const TransferTrialOptions& options = {}) {
  const testing::TemporaryFolder folder;
  for (const auto& [file, maker] : filesAndMakers) writeAsset(capsuleCharacter(maker), folder.path() / file);
  Progress progress;
  return tryTransfers(folder.path(), options, transfer, progress, skipped);
}

TEST(TransferTable, APerfectTransferHasNoErrors) {
  Warnings skipped;
  const auto transfer = [](const Asset& source, Asset& target) {
    EXPECT_FALSE(hasRig(target)) << "the target comes without its rig";
    copyRig(source, target);
  };
  const std::vector<TransferTrial> trials = trialsOver({{"a.glb", ""}, {"b.glb", ""}}, transfer, skipped);
  ASSERT_EQ(trials.size(), 2u);
  for (const TransferTrial& trial : trials) {
    EXPECT_TRUE(trial.isFamily);
    EXPECT_NE(trial.source, trial.target);
    EXPECT_LT(trial.rig.namedWorst, 1e-3);
    EXPECT_LT(trial.weightsL1, 1e-5);
    EXPECT_LT(trial.deformP95, 1e-3);
  }
  EXPECT_TRUE(skipped.empty());
}

TEST(TransferTable, AShiftOfTheRigIsTheErrorOfEachJoint) {
  Warnings skipped;
  const Box box = [] {
    Box result;
    for (const Vec3f& p : collectGeometry(capsuleCharacter("")).positions) result.add(p.cast<double>());
    return result;
  }();
  const double height = box.max.y() - box.min.y();
  const auto transfer = [&](const Asset& source, Asset& target) { copyRig(source, target, Vec3(0.03 * height, 0, 0)); };
  const std::vector<TransferTrial> trials = trialsOver({{"a.glb", ""}, {"b.glb", ""}}, transfer, skipped);
  ASSERT_EQ(trials.size(), 2u);
  EXPECT_NEAR(trials[0].rig.namedMean, 3, 0.05);
  EXPECT_NEAR(trials[0].rig.namedWorst, 3, 0.05);
}

TEST(TransferTable, OtherMakersAreTheirOwnKindAndWeighedByParts) {
  Warnings skipped;
  const auto transfer = [](const Asset& source, Asset& target) { copyRig(source, target); };
  const std::vector<TransferTrial> trials =
      trialsOver({{"a.glb", ""}, {"b.glb", "_other"}, {"c.glb", "_other"}}, transfer, skipped, {1});
  std::vector<bool> kinds;
  for (const TransferTrial& trial : trials) {
    kinds.push_back(trial.isFamily);
    EXPECT_LT(trial.weightsL1, 1e-5) << trial.source << " to " << trial.target;
  }
  EXPECT_THAT(kinds, ElementsAre(false, true, false, true, false)) << "a has no family, b and c have each other";
}

TEST(TransferTable, WhatCannotBeTransferredIsCountedAndLeftOut) {
  Warnings skipped;
  const auto transfer = [](const Asset&, Asset&) { throw Error(ErrorCode::kUnsupported, "does not fit"); };
  EXPECT_TRUE(trialsOver({{"a.glb", ""}, {"b.glb", ""}}, transfer, skipped).empty());
  ASSERT_EQ(skipped.items().size(), 1u);
  EXPECT_EQ(skipped.items()[0].kind, "not-transferred");
  EXPECT_EQ(skipped.items()[0].count, 2u);
  const auto cancelled = [](const Asset&, Asset&) { throw Error(ErrorCode::kCancelled, "stopped"); };
  EXPECT_THROW(trialsOver({{"a.glb", ""}, {"b.glb", ""}}, cancelled, skipped), Error);
}

TransferTrial trialOf(bool isFamily, double mean, double worst, double l1) {
  TransferTrial trial;
  trial.source = "from";
  trial.target = "to";
  trial.isFamily = isFamily;
  trial.rig.named = {{"hips", mean}, {"leftHand", worst}};
  trial.rig.namedMean = mean;
  trial.rig.namedWorst = worst;
  trial.weightsL1 = l1;
  trial.outOfReachL1 = l1 / 5;
  trial.seconds = 2;
  return trial;
}

TEST(TransferTable, HasMeansOfEachKind) {
  const TransferFolder folder{"tune",
                              {trialOf(true, 1, 4, 0.25), trialOf(true, 2, 8, 0.75), trialOf(false, 3, 9, 1.5)}};
  const std::string table = toMarkdown(transferTable(std::vector{folder, TransferFolder{"empty", {}}}));
  EXPECT_THAT(table, HasSubstr("| tune | same joints | 2 | 1.50 | 6.00 | 0.500 | 0.100 | 2.00 |\n"));
  EXPECT_THAT(table, HasSubstr("| tune | other makers' | 1 | 3.00 | 9.00 | 1.500 | 0.300 | 2.00 |\n"));
  EXPECT_EQ(table.find("empty"), std::string::npos);
}

TEST(TransferTable, TellsEachTrialWithItsWorstJoint) {
  const std::string text = toTsv(eachTransferTrial(std::vector{TransferFolder{"tune", {trialOf(true, 1, 4, 0.25)}}}));
  EXPECT_THAT(text, HasSubstr("\ntune\tfrom\tto\t1\t1.000\t4.000\tleftHand\t0.2500\t0.0500\t0.000\t2.00\n"));
}

}  // namespace
}  // namespace limber
