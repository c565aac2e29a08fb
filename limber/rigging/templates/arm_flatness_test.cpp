#include "limber/rigging/templates/arm_flatness.h"

#include <gtest/gtest.h>

#include "limber/rigging/body/testing/measured_person.h"

namespace limber {

namespace {

// The humanoid with the arms of the capsule person.
std::vector<Vec3> positionsIn(const testing::CapsulePerson& shape, const AnatomicalFrame& frame) {
  const TemplateSkeleton& skeleton = findTemplate("humanoid");
  std::vector<Vec3> positions;
  for (const TemplateJoint& joint : skeleton.joints) positions.push_back(joint.position);
  for (const auto& [name, position] :
       {std::pair("UpperArm", shape.shoulder), std::pair("LowerArm", shape.elbow), std::pair("Hand", shape.hand)}) {
    const Vec3 left = frame.toBody(position);
    positions[*skeleton.find(std::string("left") + name)] = left;
    positions[*skeleton.find(std::string("right") + name)] = left.cwiseProduct(Vec3(-1, 1, 1));
  }
  return positions;
}

}  // namespace

TEST(ArmFlatness, ArmsAreRound) {
  const testing::MeasuredPerson& person = testing::measuredPerson();
  EXPECT_LT(armFlatness(findTemplate("humanoid"), positionsIn(person.shape, person.frame), person.body, person.frame),
            1.5);
}

TEST(ArmFlatness, WingsAreNot) {
  testing::CapsulePerson winged = testing::capsulePerson(0);
  for (const double s : {1.0, -1.0}) {
    for (double z = -0.15; z <= 0.151; z += 0.03) {
      testing::addCapsule(winged.mesh, {s * 0.1, 0.78, z}, {s * 0.5, 0.78, z}, 0.02);
    }
  }
  const BodyVolume body = measureBody(winged.mesh);
  const AnatomicalFrame frame = frameAlong(winged.mesh, body, Vec3::UnitY(), Vec3::UnitZ());
  EXPECT_GT(armFlatness(findTemplate("humanoid"), positionsIn(winged, frame), body, frame), 4);
}

TEST(ArmFlatness, IsOneWithoutArms) {
  const testing::MeasuredPerson& person = testing::measuredPerson();
  const TemplateSkeleton& bird = findTemplate("bird");
  EXPECT_EQ(armFlatness(bird, std::vector<Vec3>(bird.joints.size()), person.body, person.frame), 1);
  // Arms beside the body.
  std::vector<Vec3> positions = positionsIn(person.shape, person.frame);
  for (Vec3& position : positions) position.y() += 2;
  EXPECT_EQ(armFlatness(findTemplate("humanoid"), positions, person.body, person.frame), 1);
}

}  // namespace limber
