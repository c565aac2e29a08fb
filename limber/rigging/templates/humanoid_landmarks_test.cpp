#include "limber/rigging/templates/humanoid_landmarks.h"

#include <gtest/gtest.h>

#include "limber/rigging/body/testing/measured_person.h"
#include "limber/rigging/templates/template_embedding.h"

namespace limber {

using testing::MeasuredPerson;
using testing::measuredPerson;

TEST(HumanoidLandmarks, HipsGoWhereLegsPart) {
  const MeasuredPerson& person = measuredPerson();
  const TemplateSkeleton& skeleton = findTemplate("humanoid");
  const Index hip = *skeleton.find("leftUpperLeg"), knee = *skeleton.find("leftLowerLeg");
  std::vector<Vec3> places;
  for (const TemplateJoint& joint : skeleton.joints) places.push_back(joint.place);
  places[hip].y() += 0.07;  // an embedding that is off
  places[*skeleton.find("rightUpperLeg")].y() += 0.07;
  std::vector<std::optional<Vec3>> pins(places.size());
  refineHumanoid(skeleton, person.body, person.frame, pins, places);
  EXPECT_LT((places[hip] - person.frame.toBody(person.shape.hip)).norm(), 0.04);
  EXPECT_NEAR(places[knee].x(), 0.08, 0.01);

  std::vector<Vec3> pinned = places;
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
  const TemplateSkeleton& skeleton = findTemplate("humanoid");
  const Index hip = *skeleton.find("leftUpperLeg"), other = *skeleton.find("rightUpperLeg");
  std::vector<Vec3> places;
  for (const TemplateJoint& joint : skeleton.joints) places.push_back(joint.place);
  const double height = places[hip].y();
  refineHumanoid(skeleton, body, frame, std::vector<std::optional<Vec3>>(places.size()), places);
  EXPECT_LT((places[hip] - Vec3(0.11, height, 0)).norm(), 0.01);
  EXPECT_LT((places[other] - Vec3(-0.11, height, 0)).norm(), 0.01);
}

TEST(HumanoidLandmarks, ArmsGoWhereTheyLeaveTheTrunk) {
  const MeasuredPerson& person = measuredPerson();
  const TemplateSkeleton& skeleton = findTemplate("humanoid");
  const Index shoulder = *skeleton.find("leftUpperArm"), elbow = *skeleton.find("leftLowerArm"),
              hand = *skeleton.find("leftHand");
  const Vec3 shoulderThere = person.frame.toBody(person.shape.shoulder);
  const Vec3 along = (person.frame.toBody(person.shape.hand) - shoulderThere).normalized();
  std::vector<Vec3> places;
  for (const TemplateJoint& joint : skeleton.joints) places.push_back(joint.place);
  places[elbow] = person.frame.toBody(person.shape.elbow) + Vec3(0, 0.01, 0.01);
  places[hand] = person.frame.toBody(person.shape.hand) + Vec3(0, 0.01, 0.01);
  std::vector<Vec3> far = places;
  places[shoulder] = shoulderThere;
  far[shoulder] = shoulderThere + 0.05 * along;  // an embedding that is off
  const std::vector<std::optional<Vec3>> pins(places.size());
  refineHumanoid(skeleton, person.body, person.frame, pins, places);
  refineHumanoid(skeleton, person.body, person.frame, pins, far);
  EXPECT_LT((places[shoulder] - shoulderThere).norm(), 0.04);
  EXPECT_LT((far[shoulder] - places[shoulder]).norm(), 0.03);
  EXPECT_LT((places[elbow] - person.frame.toBody(person.shape.elbow)).norm(), 0.015);
}

TEST(HumanoidLandmarks, ShouldersStayAboveArmsThatHang) {
  const testing::CapsulePerson person = testing::capsulePerson(1.3);
  const BodyVolume body = measureBody(person.mesh);
  const AnatomicalFrame frame = frameAlong(person.mesh, body, Vec3::UnitY(), Vec3::UnitZ());
  const TemplateSkeleton& skeleton = findTemplate("humanoid");
  const Index shoulder = *skeleton.find("leftUpperArm");
  std::vector<Vec3> places;
  for (const TemplateJoint& joint : skeleton.joints) places.push_back(joint.place);
  for (const std::string side : {"left", "right"}) {
    const Vec3 mirror(side == "left" ? 1 : -1, 1, 1);
    places[*skeleton.find(side + "UpperArm")] = frame.toBody(person.shoulder.cwiseProduct(mirror));
    places[*skeleton.find(side + "LowerArm")] = frame.toBody(person.elbow.cwiseProduct(mirror));
    places[*skeleton.find(side + "Hand")] = frame.toBody(person.hand.cwiseProduct(mirror));
  }
  refineHumanoid(skeleton, body, frame, std::vector<std::optional<Vec3>>(places.size()), places);
  EXPECT_LT((places[shoulder] - frame.toBody(person.shoulder)).norm(), 0.02);
}

TEST(HumanoidLandmarks, AShorterArmIsAsLongAsTheOther) {
  const MeasuredPerson& person = measuredPerson();
  const TemplateSkeleton& skeleton = findTemplate("humanoid");
  const Index hand = *skeleton.find("leftHand"), other = *skeleton.find("rightHand");
  std::vector<Vec3> places;
  for (const TemplateJoint& joint : skeleton.joints) places.push_back(joint.place);
  for (const std::string side : {"left", "right"}) {
    const Vec3 mirror(side == "left" ? 1 : -1, 1, 1);
    const Vec3 shoulder = person.frame.toBody(person.shape.shoulder);
    const double share = side == "left" ? 1 : 0.7;  // an embedding that stopped short of the right hand
    const auto set = [&](const char* bone, const Vec3& place) {
      places[*skeleton.find(side + bone)] = (shoulder + share * (place - shoulder)).cwiseProduct(mirror);
    };
    set("UpperArm", shoulder);
    set("LowerArm", person.frame.toBody(person.shape.elbow));
    set("Hand", person.frame.toBody(person.shape.hand));
  }
  refineHumanoid(skeleton, person.body, person.frame, std::vector<std::optional<Vec3>>(places.size()), places);
  EXPECT_LT((places[other].cwiseProduct(Vec3(-1, 1, 1)) - places[hand]).norm(), 0.01);
}

TEST(HumanoidLandmarks, KneesAreBeforeTheMiddleOfTheLegAndTheChestBehindIts) {
  const MeasuredPerson& person = measuredPerson();
  const TemplateSkeleton& skeleton = findTemplate("humanoid");
  const Index knee = *skeleton.find("leftLowerLeg"), chest = *skeleton.find("upperChest");
  std::vector<Vec3> places;
  for (const TemplateJoint& joint : skeleton.joints) places.push_back(joint.place);
  std::vector<Vec3> middle = places;
  const std::vector<std::optional<Vec3>> pins(places.size());
  HumanoidProportions inTheMiddle;
  inTheMiddle.kneeForward = inTheMiddle.chestBack = 0;
  refineHumanoid(skeleton, person.body, person.frame, pins, places);
  refineHumanoid(skeleton, person.body, person.frame, pins, middle, inTheMiddle);
  EXPECT_NEAR(middle[knee].z(), person.frame.toBody(person.shape.knee).z(), 0.01);
  EXPECT_NEAR(places[knee].z() - middle[knee].z(), HumanoidProportions().kneeForward * 0.045, 0.005);
  EXPECT_NEAR(middle[chest].z() - places[chest].z(), HumanoidProportions().chestBack * 0.085, 0.006);
}

TEST(HumanoidLandmarks, LeavesOtherTemplatesAlone) {
  const MeasuredPerson& person = measuredPerson();
  const TemplateSkeleton& skeleton = findTemplate("quadruped");
  std::vector<Vec3> places;
  for (const TemplateJoint& joint : skeleton.joints) places.push_back(joint.place);
  std::vector<Vec3> refined = places;
  refineHumanoid(skeleton, person.body, person.frame, std::vector<std::optional<Vec3>>(places.size()), refined);
  EXPECT_EQ(refined, places);
}

}  // namespace limber
