#include "limber/rigging/templates/humanoid_landmarks.h"

#include <gtest/gtest.h>

#include "limber/rigging/body/testing/measured_person.h"

namespace limber {

using testing::MeasuredPerson;
using testing::measuredPerson;

TEST(HumanoidLandmarks, HipsGoWhereLegsPart) {
  const MeasuredPerson& person = measuredPerson();
  const TemplateSkeleton& skeleton = *findTemplate("humanoid");
  const Index hip = *skeleton.find("leftUpperLeg"), knee = *skeleton.find("leftLowerLeg");
  std::vector<Vec3> positions;
  for (const TemplateJoint& joint : skeleton.joints) positions.push_back(joint.position);
  positions[hip].y() += 0.07;  // a reading that is off
  positions[*skeleton.find("rightUpperLeg")].y() += 0.07;
  std::vector<std::optional<Vec3>> pins(positions.size());
  refineHumanoid(skeleton, person.body, person.frame, pins, positions);
  EXPECT_LT((positions[hip] - person.frame.toBody(person.shape.hip)).norm(), 0.04);
  EXPECT_NEAR(positions[knee].x(), 0.08, 0.01);

  std::vector<Vec3> pinned = positions;
  pins[hip] = pinned[hip] = Vec3(0.05, 0.6, 0);
  refineHumanoid(skeleton, person.body, person.frame, pins, pinned);
  EXPECT_EQ(pinned[hip], *pins[hip]);
}

TEST(HumanoidLandmarks, LegsThatNeverMeetHaveTheirHipsInTheirMiddle) {
  TriMesh robot;
  testing::addCapsule(robot, {0, 0.65, 0}, {0, 0.93, 0}, 0.07);
  for (const double x : {0.11, -0.11}) testing::addCapsule(robot, {x, 0.045, 0}, {x, 0.52, 0}, 0.045);
  const BodyVolume body = measureBody(robot);
  const AnatomicalFrame frame = frameAlong(robot, body, Vec3::UnitY(), Vec3::UnitZ());
  const TemplateSkeleton& skeleton = *findTemplate("humanoid");
  const Index hip = *skeleton.find("leftUpperLeg"), other = *skeleton.find("rightUpperLeg");
  std::vector<Vec3> positions;
  for (const TemplateJoint& joint : skeleton.joints) positions.push_back(joint.position);
  const double height = positions[hip].y();
  refineHumanoid(skeleton, body, frame, std::vector<std::optional<Vec3>>(positions.size()), positions);
  EXPECT_LT((positions[hip] - Vec3(0.11, height, 0)).norm(), 0.01);
  EXPECT_LT((positions[other] - Vec3(-0.11, height, 0)).norm(), 0.01);
}

TEST(HumanoidLandmarks, ArmsGoWhereTheyLeaveTheTrunk) {
  const MeasuredPerson& person = measuredPerson();
  const TemplateSkeleton& skeleton = *findTemplate("humanoid");
  const Index shoulder = *skeleton.find("leftUpperArm"), elbow = *skeleton.find("leftLowerArm"),
              hand = *skeleton.find("leftHand");
  const Vec3 shoulderThere = person.frame.toBody(person.shape.shoulder);
  const Vec3 along = (person.frame.toBody(person.shape.hand) - shoulderThere).normalized();
  std::vector<Vec3> positions;
  for (const TemplateJoint& joint : skeleton.joints) positions.push_back(joint.position);
  positions[elbow] = person.frame.toBody(person.shape.elbow) + Vec3(0, 0.01, 0.01);
  positions[hand] = person.frame.toBody(person.shape.hand) + Vec3(0, 0.01, 0.01);
  std::vector<Vec3> far = positions;
  positions[shoulder] = shoulderThere;
  far[shoulder] = shoulderThere + 0.05 * along;  // a reading that is off
  const std::vector<std::optional<Vec3>> pins(positions.size());
  refineHumanoid(skeleton, person.body, person.frame, pins, positions);
  refineHumanoid(skeleton, person.body, person.frame, pins, far);
  EXPECT_LT((positions[shoulder] - shoulderThere).norm(), 0.04);
  EXPECT_LT((far[shoulder] - positions[shoulder]).norm(), 0.03);
  EXPECT_LT((positions[elbow] - person.frame.toBody(person.shape.elbow)).norm(), 0.015);
}

TEST(HumanoidLandmarks, ShouldersStayAboveArmsThatHang) {
  const testing::CapsulePerson person = testing::capsulePerson(1.3);
  const BodyVolume body = measureBody(person.mesh);
  const AnatomicalFrame frame = frameAlong(person.mesh, body, Vec3::UnitY(), Vec3::UnitZ());
  const TemplateSkeleton& skeleton = *findTemplate("humanoid");
  const Index shoulder = *skeleton.find("leftUpperArm");
  std::vector<Vec3> positions;
  for (const TemplateJoint& joint : skeleton.joints) positions.push_back(joint.position);
  for (const std::string side : {"left", "right"}) {
    const Vec3 mirror(side == "left" ? 1 : -1, 1, 1);
    positions[*skeleton.find(side + "UpperArm")] = frame.toBody(person.shoulder.cwiseProduct(mirror));
    positions[*skeleton.find(side + "LowerArm")] = frame.toBody(person.elbow.cwiseProduct(mirror));
    positions[*skeleton.find(side + "Hand")] = frame.toBody(person.hand.cwiseProduct(mirror));
  }
  refineHumanoid(skeleton, body, frame, std::vector<std::optional<Vec3>>(positions.size()), positions);
  EXPECT_LT((positions[shoulder] - frame.toBody(person.shoulder)).norm(), 0.02);
}

TEST(HumanoidLandmarks, AShorterArmIsAsLongAsTheOther) {
  const MeasuredPerson& person = measuredPerson();
  const TemplateSkeleton& skeleton = *findTemplate("humanoid");
  const Index hand = *skeleton.find("leftHand"), other = *skeleton.find("rightHand");
  std::vector<Vec3> positions;
  for (const TemplateJoint& joint : skeleton.joints) positions.push_back(joint.position);
  for (const std::string side : {"left", "right"}) {
    const Vec3 mirror(side == "left" ? 1 : -1, 1, 1);
    const Vec3 shoulder = person.frame.toBody(person.shape.shoulder);
    const double fraction = side == "left" ? 1 : 0.7;  // a reading that stopped short of the right hand
    const auto set = [&](const char* bone, const Vec3& position) {
      positions[*skeleton.find(side + bone)] = (shoulder + fraction * (position - shoulder)).cwiseProduct(mirror);
    };
    set("UpperArm", shoulder);
    set("LowerArm", person.frame.toBody(person.shape.elbow));
    set("Hand", person.frame.toBody(person.shape.hand));
  }
  refineHumanoid(skeleton, person.body, person.frame, std::vector<std::optional<Vec3>>(positions.size()), positions);
  EXPECT_LT((positions[other].cwiseProduct(Vec3(-1, 1, 1)) - positions[hand]).norm(), 0.01);
}

TEST(HumanoidLandmarks, KneesAreBeforeTheMiddleOfTheLegAndTheChestBehindIts) {
  const MeasuredPerson& person = measuredPerson();
  const TemplateSkeleton& skeleton = *findTemplate("humanoid");
  const Index knee = *skeleton.find("leftLowerLeg"), chest = *skeleton.find("upperChest");
  std::vector<Vec3> positions;
  for (const TemplateJoint& joint : skeleton.joints) positions.push_back(joint.position);
  std::vector<Vec3> middle = positions;
  const std::vector<std::optional<Vec3>> pins(positions.size());
  HumanoidProportions inTheMiddle;
  inTheMiddle.kneeForward = inTheMiddle.chestBack = 0;
  refineHumanoid(skeleton, person.body, person.frame, pins, positions);
  refineHumanoid(skeleton, person.body, person.frame, pins, middle, inTheMiddle);
  EXPECT_NEAR(middle[knee].z(), person.frame.toBody(person.shape.knee).z(), 0.01);
  EXPECT_NEAR(positions[knee].z() - middle[knee].z(), HumanoidProportions().kneeForward * 0.045, 0.005);
  EXPECT_NEAR(middle[chest].z() - positions[chest].z(), HumanoidProportions().chestBack * 0.085, 0.006);
}

TEST(HumanoidLandmarks, LeavesOtherTemplatesAlone) {
  const MeasuredPerson& person = measuredPerson();
  const TemplateSkeleton& skeleton = *findTemplate("quadruped");
  std::vector<Vec3> positions;
  for (const TemplateJoint& joint : skeleton.joints) positions.push_back(joint.position);
  std::vector<Vec3> refined = positions;
  refineHumanoid(skeleton, person.body, person.frame, std::vector<std::optional<Vec3>>(positions.size()), refined);
  EXPECT_EQ(refined, positions);
}

}  // namespace limber
