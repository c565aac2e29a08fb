#include "limber/rigging/humanoid_landmarks.h"

#include <gtest/gtest.h>

#include "limber/rigging/template_embedding.h"
#include "limber/rigging/testing/measured_person.h"

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
