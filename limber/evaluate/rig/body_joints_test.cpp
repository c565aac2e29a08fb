#include "limber/evaluate/rig/body_joints.h"

#include <gtest/gtest.h>

#include "limber/character/anatomy/testing/bodies.h"

namespace limber {

namespace {

struct NamedPosition {
  const char *name, *parent;
  Vec3 position;
};

Skeleton skeletonOf(std::initializer_list<NamedPosition> joints) {
  Skeleton skeleton;
  std::vector<Vec3> positions;
  for (const NamedPosition& from : joints) {
    Joint joint;
    joint.name = from.name;
    if (*from.parent != 0) joint.parent = skeleton.find(from.parent).value();
    joint.rest.translation = from.position - (joint.parent ? positions[*joint.parent] : Vec3(Vec3::Zero()));
    positions.push_back(from.position);
    skeleton.joints.push_back(joint);
  }
  return skeleton;
}

std::vector<std::string> kept(const Skeleton& skeleton) {
  const std::vector<bool> body = bodyJoints(skeleton, std::vector<bool>(skeleton.jointCount(), true));
  std::vector<std::string> names;
  for (Index j = 0; j < skeleton.jointCount(); ++j) {
    if (body[j]) names.push_back(skeleton.joints[j].name);
  }
  return names;
}

}  // namespace

TEST(BodyJoints, LeavesOutWhatHangsOnHandsHeadAndFeet) {
  const Skeleton skeleton = skeletonOf({{"Hips", "", {0, 1, 0}},
                                        {"Spine", "Hips", {0, 1.2, 0}},
                                        {"Head", "Spine", {0, 1.5, 0}},
                                        {"Ear1.L", "Head", {0.1, 1.6, 0}},
                                        {"Tuft", "Ear1.L", {0.1, 1.7, 0}},
                                        {"Breast.L", "Spine", {0.1, 1.3, 0.1}},
                                        {"UpperArm.L", "Spine", {0.2, 1.4, 0}},
                                        {"LowerArm.L", "UpperArm.L", {0.4, 1.4, 0}},
                                        {"Hand.L", "LowerArm.L", {0.6, 1.4, 0}},
                                        {"Sword", "Hand.L", {0.7, 1.4, 0}},
                                        {"UpperLeg.L", "Hips", {0.1, 0.9, 0}},
                                        {"LowerLeg.L", "UpperLeg.L", {0.1, 0.5, 0}},
                                        {"Foot.L", "LowerLeg.L", {0.1, 0.1, 0}},
                                        {"Toes.L", "Foot.L", {0.1, 0, 0.1}},
                                        {"Toes.L_end", "Toes.L", {0.1, 0, 0.2}}});
  const std::vector<std::string> body = {"Hips",   "Spine",      "Head",       "UpperArm.L", "LowerArm.L",
                                         "Hand.L", "UpperLeg.L", "LowerLeg.L", "Foot.L",     "Toes.L"};
  EXPECT_EQ(kept(skeleton), body);
}

TEST(BodyJoints, CountOnePlaceOnceAndHangFeetOnTheirLegs) {
  const Skeleton skeleton = skeletonOf({{"Hips", "", {0, 1, 0}},
                                        {"Knee", "Hips", {0, 0.5, 0}},
                                        {"PalmA", "Knee", {0, 0.3, 0}},
                                        {"PalmB", "Knee", {0, 0.3, 0}},
                                        {"Driven", "", {0, 0, 0.1}}});
  const BodyFigure figure = figureOf(skeleton, std::vector<bool>(skeleton.jointCount(), true));
  EXPECT_EQ(figure.joints.size(), 4u);
  ASSERT_EQ(figure.bones.size(), 3u);
  EXPECT_LT((figure.bones.back().a - Vec3(0, 0.3, 0)).norm(), 1e-9);
  EXPECT_LT((figure.bones.back().b - Vec3(0, 0, 0.1)).norm(), 1e-9);
}

TEST(BodyJoints, CountWhatMovesVertices) {
  SkinnedModel model;
  model.skeleton = skeletonOf({{"a", "", {0, 0, 0}}, {"b", "a", {0, 1, 0}}, {"c", "b", {0, 2, 0}}});
  model.weights.slots = 2;
  model.weights.joints = {0, 1, 0, 2};
  model.weights.weights = {0.5f, 0.5f, 0.97f, 0.03f};  // the last moves its vertex hardly
  EXPECT_EQ(countedJoints(model), (std::vector<bool>{true, true, false}));
  // What plays a bone counts, though it holds nothing.
  model = {};
  model.skeleton = testing::vrmPerson();
  testing::addJoint(model.skeleton, "control", "hips", Vec3(0, 0.1, 0.9));
  const std::vector<bool> counted = countedJoints(model);
  EXPECT_TRUE(counted[*model.skeleton.find("leftFoot")]);
  EXPECT_FALSE(counted[*model.skeleton.find("control")]);
}

}  // namespace limber
