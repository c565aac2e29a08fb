#include "limber/evaluate/rig/rig_metrics.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "limber/character/anatomy/testing/bodies.h"
#include "limber/evaluate/rig/rig_table.h"

namespace limber {

namespace {

// Joints in a row, 1 apart, each holding a vertex; the box is 10 long.
SkinnedModel row(std::initializer_list<const char*> names, const Vec3& offset = Vec3::Zero()) {
  SkinnedModel model;
  model.mesh.positions = {{0, 0, 0}, {0, 10, 0}, {1, 0, 0}};
  model.mesh.triangles = {{0, 1, 2}};
  model.weights.slots = 1;
  for (const char* name : names) {
    Joint joint;
    joint.name = name;
    if (!model.skeleton.joints.empty()) joint.parent = model.skeleton.jointCount() - 1;
    joint.rest.translation = joint.parent ? Vec3(0, 1, 0) : offset;
    model.weights.joints.push_back(model.skeleton.jointCount());
    model.weights.weights.push_back(1);
    model.skeleton.joints.push_back(joint);
  }
  return model;
}

}  // namespace

TEST(RigMetrics, OfTheSameRigAreNought) {
  const SkinnedModel model = row({"a", "b", "c"});
  const RigComparison comparison = compareRigs(model, model);
  EXPECT_EQ(comparison.all.jointToJoint, 0);
  EXPECT_EQ(comparison.all.jointToBone, 0);
  EXPECT_EQ(comparison.all.boneToBone, 0);
  EXPECT_EQ(comparison.all.iou, 1);
  EXPECT_TRUE(comparison.named.empty());
}

TEST(RigMetrics, AreInPercentOfTheLongestSide) {
  // Moved aside by 0.2, which is 2 % of 10.
  const RigComparison aside = compareRigs(row({"a", "b", "c"}, {0.2, 0, 0}), row({"a", "b", "c"}));
  EXPECT_NEAR(aside.all.jointToJoint, 2, 1e-9);
  EXPECT_NEAR(aside.all.jointToBone, 2, 1e-9);
  EXPECT_NEAR(aside.all.boneToBone, 2, 1e-6);
  EXPECT_EQ(aside.all.precision, 1);
  EXPECT_EQ(compareRigs(row({"a", "b", "c"}, {0.6, 0, 0}), row({"a", "b", "c"})).all.recall, 0);
  // Moved along by half a bone: joints lie on bones but at one end, bones on bones but for half of one.
  const RigComparison along = compareRigs(row({"a", "b", "c"}, {0, 0.5, 0}), row({"a", "b", "c"}));
  EXPECT_NEAR(along.all.jointToJoint, 5, 1e-9);
  EXPECT_NEAR(along.all.jointToBone, 5.0 / 3, 0.05);
  EXPECT_NEAR(along.all.boneToBone, 5.0 / 8, 0.05);
}

TEST(RigMetrics, LeaveOutJointsThatHoldNothing) {
  const SkinnedModel predicted = row({"a", "b"});
  SkinnedModel truth = row({"a", "b", "control"});
  truth.weights.weights[2] = 0;
  const RigComparison comparison = compareRigs(predicted, truth);
  EXPECT_EQ(comparison.all.truthJoints, 2u);
  EXPECT_EQ(comparison.all.jointToJoint, 0);
  truth.weights.weights = {1, 0, 1};  // between two that hold some
  EXPECT_EQ(compareRigs(predicted, truth).all.truthJoints, 3u);
  EXPECT_EQ(compareRigs(truth, truth).all.joints, 3u);
}

// Some artists' trunks have two bones, and what they call the chest is where the arms hang.
TEST(RigMetrics, AChestAloneIsTheNearerOfTwo) {
  SkinnedModel predicted = row({"a", "b", "c"});
  predicted.skeleton = testing::vrmPerson();
  SkinnedModel truth = predicted;
  Skeleton& shorter = truth.skeleton;  // its chest is where the predicted upper chest is
  shorter.joints[2].rest.translation += shorter.joints[3].rest.translation;
  for (Joint& joint : shorter.joints) {
    if (joint.parent && *joint.parent >= 3) joint.parent = *joint.parent - 1;
  }
  shorter.joints.erase(shorter.joints.begin() + 3);
  const auto chest = [&] {
    for (const NamedJointError& error : compareRigs(predicted, truth).named) {
      if (error.bone == "chest") return error.percent;
    }
    return -1.0;
  };
  EXPECT_NEAR(chest(), 0, 1e-9);
  truth = predicted;
  truth.skeleton.joints[2].rest.translation.y() += 0.1;
  truth.skeleton.joints[3].rest.translation.y() -= 0.1;
  EXPECT_GT(chest(), 0.5);  // where both have one, each is compared with its own
}

TEST(RigTable, SaysWhatWasMeasured) {
  const RigComparison comparison = compareRigs(row({"a", "b", "c"}, {0.2, 0, 0}), row({"a", "b", "c"}));
  EXPECT_NEAR(toJson(comparison)["all"]["joint_to_joint"].get<double>(), 2, 1e-9);
  EXPECT_NE(toText(comparison).find("J2J 2.00 %"), std::string::npos);
  const std::vector<RigTableRow> rows = {{"one.glb", "one", {false, "humanoid", 0.9}, comparison, 0.5},
                                         {"two.glb", "two", {false, "humanoid", 0.8}, {}, 1.5}};
  const std::string table = toMarkdown(rigTable(rows));
  EXPECT_NE(table.find("| one | humanoid 0.90 | 3/3 | 2.00 |"), std::string::npos);
  EXPECT_NE(table.find("| **mean of 2** | | | 1.00 |"), std::string::npos);
}

TEST(RigMetrics, CountJointsInside) {
  // A tetrahedron that faces outwards; the joints lie at y = 0.1, 1.1 and 2.1, its tip at 2.
  SkinnedModel model = row({"a", "b", "c"}, {0.1, 0.1, 0.1});
  model.mesh.positions = {{0, 0, 0}, {2, 0, 0}, {0, 2, 0}, {0, 0, 2}};
  model.mesh.triangles = {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}};
  EXPECT_NEAR(insideFraction(model), 2.0 / 3, 1e-12);
}

}  // namespace limber
